#include "delaunayGraphMotionSolver.H"

#include "addToRunTimeSelectionTable.H"
#include "mapPolyMesh.H"
#include "valuePointPatchField.H"

namespace Foam
{
    defineTypeNameAndDebug(delaunayGraphMotionSolver, 0);

    addToRunTimeSelectionTable
    (
        motionSolver,
        delaunayGraphMotionSolver,
        dictionary
    );
}

static_assert(sizeof(Foam::scalar) == sizeof(double), "motet's arrays are of doubles: build OpenFOAM with WM_PRECISION_OPTION=DP");

namespace
{

const double* doubles(const Foam::UList<Foam::vector>& list)
{
    return reinterpret_cast<const double*>(list.cdata());
}

//- The lists of all processes, one after the other; returned on every process
Foam::pointField gathered(const Foam::pointField& own)
{
    Foam::List<Foam::pointField> all(Foam::Pstream::nProcs());
    all[Foam::Pstream::myProcNo()] = own;
    Foam::Pstream::gatherList(all);
    Foam::Pstream::scatterList(all);

    Foam::label n = 0;
    for (const Foam::pointField& part : all)
    {
        n += part.size();
    }
    Foam::pointField joined(n);
    n = 0;
    for (const Foam::pointField& part : all)
    {
        for (const Foam::point& p : part)
        {
            joined[n++] = p;
        }
    }
    return joined;
}

void check(motet_status status, motet_error* error, const char* what)
{
    if (status != MOTET_OK)
    {
        const Foam::string message(motet_error_message(error));
        motet_error_free(error);
        FatalErrorInFunction << what << ": " << message << Foam::exit(Foam::FatalError);
    }
}

} // End namespace


Foam::delaunayGraphMotionSolver::delaunayGraphMotionSolver
(
    const polyMesh& mesh,
    const IOdictionary& dict
)
:
    displacementMotionSolver(mesh, dict, typeName)
{}


void Foam::delaunayGraphMotionSolver::setUp()
{
    boolList isNode(mesh().nPoints(), false);
    forAll(pointDisplacement_.boundaryField(), patchi)
    {
        const pointPatchVectorField& field = pointDisplacement_.boundaryField()[patchi];
        if (isA<valuePointPatchField<vector>>(field) && !field.coupled())
        {
            for (const label pointi : field.patch().meshPoints())
            {
                isNode[pointi] = true;
            }
        }
    }
    nodes_ = findIndices(isNode, true);

    const pointField nodes(gathered(pointField(points0(), nodes_)));
    motet_point_mover* mover = nullptr;
    motet_error* error = nullptr;
    const motet_status status = motet_point_mover_new
    (
        doubles(nodes), nodes.size(), 3, doubles(points0()), points0().size(), 3, 1, &mover, &error
    );
    check(status, error, "the Delaunay graph of the points whose displacement is given");
    mover_.reset(mover);
    Info<< "delaunayGraph: " << nodes.size() << " nodes" << endl;
}


void Foam::delaunayGraphMotionSolver::solve()
{
    if (!mover_)
    {
        setUp();
    }

    // Patches with a value write it into the field.
    pointDisplacement_.correctBoundaryConditions();

    const pointField displacement(gathered(pointField(pointDisplacement_.primitiveField(), nodes_)));
    pointField moved(mesh().nPoints());
    motet_error* error = nullptr;
    const motet_status status = motet_point_mover_step
    (
        mover_.get(), doubles(displacement), displacement.size(), 3,
        reinterpret_cast<double*>(moved.data()), moved.size(), 3, &error
    );
    check(status, error, "a step of the mesh");

    pointDisplacement_.primitiveFieldRef() = moved - points0();
    pointDisplacement_.correctBoundaryConditions();
}


Foam::tmp<Foam::pointField> Foam::delaunayGraphMotionSolver::curPoints() const
{
    tmp<pointField> points(points0() + pointDisplacement_.primitiveField());
    twoDCorrectPoints(points.ref());
    return points;
}


void Foam::delaunayGraphMotionSolver::updateMesh(const mapPolyMesh& map)
{
    displacementMotionSolver::updateMesh(map);
    mover_.reset();
}
