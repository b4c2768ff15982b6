"""Measures set-up and step of mesh motion by a linear system, in programs from PyPI.

usage: motion_python.py pardiso|pyamg|ngsolve laplace|elastic MESH.npz THREADS [TOLERANCE]

P1 elements on the tets of a sphere in a box; the sphere moves by half its radius along x, the walls are
fixed. `laplace` has diffusivity 1; iterative solvers solve only for x, since the other components are zero.
`elastic` has Poisson's ratio 0.3 and Young's modulus 1/volume (NGSolve: 1/h^3).

pardiso (MKL): stored Cholesky factorization. pyamg: conjugate gradients with Ruge-Stueben or smoothed
aggregation multigrid. ngsolve: its own assembly, and conjugate gradients with its multigrid `h1amg` (laplace)
or a diagonal preconditioner (elastic, for which it has no multigrid). Iterations stop at TOLERANCE (default
1e-8).
"""
import json
import os
import resource
import sys
import time

program, kind, path, threads = sys.argv[1:5]
tolerance = float(sys.argv[5]) if len(sys.argv) > 5 else 1e-8
for variable in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = threads
# A factorization that does not fit into memory ends this program, and does not exhaust the machine.
resource.setrlimit(resource.RLIMIT_AS, (int(0.8 * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")),) * 2)

import numpy as np  # noqa: E402  after the number of threads is set

TRAVEL, POISSON, BUDGET, MOST = 0.5, 0.3, 1.0, 20.0


def median_seconds(step):
    """Repeat a step for about a second, at least five times unless it takes long.

    Return the seconds of each.
    """
    step()
    seconds = []
    while not seconds or (sum(seconds) < MOST and (len(seconds) < 5 or sum(seconds) < BUDGET)):
        start = time.perf_counter()
        step()
        seconds.append(time.perf_counter() - start)
    return seconds


class System:
    """The matrix of the free vertices and its coupling to the boundary, assembled with NumPy and SciPy."""

    def __init__(self, mesh):
        import scipy.sparse

        self.width = 3 if kind == "elastic" else 1
        points, tets = mesh["points"], mesh["tets"].astype(np.int32)
        boundary = np.concatenate([mesh["sphere"], mesh["walls"]])
        self.free = np.setdiff1d(np.arange(len(points)), boundary)
        given = np.zeros((len(boundary), 3))
        given[: len(mesh["sphere"]), 0] = TRAVEL
        edges = points[tets[:, 1:]] - points[tets[:, :1]]
        volume = np.linalg.det(edges) / 6
        gradients = np.empty((len(tets), 4, 3))
        gradients[:, 1:] = np.linalg.inv(edges).transpose(0, 2, 1)
        gradients[:, 0] = -gradients[:, 1:].sum(axis=1)
        products = np.einsum("nia,nja->nij", gradients, gradients)
        if self.width == 1:
            blocks, rows = products * np.abs(volume)[:, None, None], tets
        else:
            lame, shear = POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), 0.5 / (1 + POISSON)
            # The modulus 1/volume times the volume is 1 everywhere.
            blocks = lame * np.einsum("nia,njb->niajb", gradients, gradients)
            blocks += shear * np.einsum("nib,nja->niajb", gradients, gradients)
            for a in range(3):
                blocks[:, :, a, :, a] += shear * products
            blocks = blocks.reshape(-1, 12, 12)
            rows = (3 * tets[:, :, None] + np.arange(3, dtype=np.int32)).reshape(-1, 12)
        k = rows.shape[1]
        n = self.width * len(points)
        whole = scipy.sparse.coo_matrix(
            (blocks.ravel(), (np.repeat(rows, k, axis=1).ravel(), np.tile(rows, (1, k)).ravel())), (n, n)).tocsr()
        del blocks
        numbers = lambda vertices: (self.width * vertices[:, None] + np.arange(self.width)).ravel()
        whole = whole[numbers(self.free)]
        self.inner = whole[:, numbers(self.free)].tocsr()
        coupling = whole[:, numbers(boundary)].tocsr()
        self.right = -(coupling @ (given if self.width == 1 else given.ravel()))
        self.places = points[self.free]

    def residual(self, solution):
        return float(np.linalg.norm(self.inner @ solution - self.right) / np.linalg.norm(self.right))


def pardiso(system):
    import pypardiso
    import scipy.sparse

    upper = scipy.sparse.triu(system.inner, format="csr")
    upper.sort_indices()
    solver = pypardiso.PyPardisoSolver(mtype=2)  # symmetric positive definite
    solver.factorize(upper)
    right = np.asfortranarray(system.right)
    solver.set_phase(33)
    last = []

    def step():
        last[:] = [solver._call_pardiso(upper, right)]

    return step, lambda: system.residual(last[0]), pypardiso.__version__


def pyamg(system):
    import pyamg

    if kind == "laplace":
        levels = pyamg.ruge_stuben_solver(system.inner)
    else:
        x, y, z = system.places.T
        modes = np.zeros((3 * len(x), 6))  # translations and rotations
        for axis in range(3):
            modes[axis::3, axis] = 1
        modes[0::3, 3], modes[1::3, 3] = -y, x
        modes[1::3, 4], modes[2::3, 4] = -z, y
        modes[2::3, 5], modes[0::3, 5] = -x, z
        levels = pyamg.smoothed_aggregation_solver(system.inner.tobsr((3, 3)), B=modes)
    last = []

    def step():
        solve = lambda right: levels.solve(right, tol=tolerance, accel="cg", maxiter=500)
        columns = [solve(c) if np.any(c) else c for c in system.right.T] if kind == "laplace" else None
        last[:] = [np.column_stack(columns) if columns else solve(system.right)]

    return step, lambda: system.residual(last[0]), pyamg.__version__


def ngsolve(mesh):
    import netgen.meshing as nm
    import ngsolve as ng

    points, tets = mesh["points"], mesh["tets"]
    inner = nm.Mesh(dim=3)
    inner.AddPoints(np.ascontiguousarray(points))
    inner.SetMaterial(1, "fluid")
    patches = [inner.Add(nm.FaceDescriptor(surfnr=i, domin=1, bc=i)) for i in (1, 2)]
    facets = np.sort(tets[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3), axis=1)
    facets, uses = np.unique(facets, axis=0, return_counts=True)
    facets = facets[uses == 1]
    on_sphere = np.isin(facets, mesh["sphere"]).all(axis=1)
    inner.AddElements(dim=3, index=1, data=np.ascontiguousarray(tets[:, [0, 2, 1, 3]].astype(np.int32)), base=0)
    for patch, which in zip(patches, (on_sphere, ~on_sphere)):
        inner.AddElements(dim=2, index=patch, data=np.ascontiguousarray(facets[which].astype(np.int32)), base=0)
    inner.SetBCName(0, "sphere")
    inner.SetBCName(1, "walls")
    start = time.perf_counter()
    domain = ng.Mesh(inner)
    held = "sphere|walls"
    if kind == "laplace":
        space = ng.H1(domain, order=1, dirichlet=held)
        (u, v), to = space.TnT(), ng.CoefficientFunction(TRAVEL)
        energy = ng.grad(u) * ng.grad(v)
    else:
        space = ng.VectorH1(domain, order=1, dirichlet=held)
        (u, v), to = space.TnT(), ng.CoefficientFunction((TRAVEL, 0, 0))
        modulus = 1 / ng.specialcf.mesh_size**3
        lame, shear = modulus * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), modulus / (2 * (1 + POISSON))
        strain = lambda w: 0.5 * (ng.Grad(w) + ng.Grad(w).trans)
        energy = lame * ng.div(u) * ng.div(v) + 2 * shear * ng.InnerProduct(strain(u), strain(v))
    form = ng.BilinearForm(space, symmetric=True)
    form += energy * ng.dx
    before = ng.Preconditioner(form, "h1amg" if kind == "laplace" else "local")
    form.Assemble()
    field = ng.GridFunction(space)
    right = field.vec.CreateVector()
    prepared = time.perf_counter() - start

    def step():
        field.Set(to, definedon=domain.Boundaries("sphere"))
        right.data = -form.mat * field.vec
        field.vec.data += ng.solvers.CGSolver(mat=form.mat, pre=before.mat, maxiter=5000, tol=tolerance) * right

    return step, ng.__version__, prepared


mesh = np.load(path)
if program == "ngsolve":
    import ngsolve as ng

    ng.SetNumThreads(int(threads))
    with ng.TaskManager():
        step, version, setup = ngsolve(mesh)
        seconds = median_seconds(step)
    left = None
else:
    start = time.perf_counter()
    step, residual, version = {"pardiso": pardiso, "pyamg": pyamg}[program](System(mesh))
    setup = time.perf_counter() - start
    seconds = median_seconds(step)
    left = residual()
print(json.dumps({"seconds": seconds, "setup_seconds": setup, "residual": left, "version": version}))
