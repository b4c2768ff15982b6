"""Keywords, representations and pickling of the public functions and classes."""
import copy
import inspect
import pickle

import numpy as np
import pytest

import motet
from motet import shapes

# Keywords that PyVista checks.
PASSED_ON = {"Mesh.plot"}


def public():
    """All public functions and methods of the package, by name."""
    found = {}
    for owner, prefix in ((motet, ""), (shapes, "shapes.")):
        for name in getattr(owner, "__all__", [n for n in vars(owner) if inspect.isfunction(getattr(owner, n))]):
            thing = getattr(owner, name)
            if inspect.isfunction(thing) and thing.__module__.startswith("motet") and not name.startswith("_") and name not in ("checked", "point"):
                found[prefix + name] = thing
            elif inspect.isclass(thing) and not issubclass(thing, (Exception, dict)):
                methods = inspect.getmembers(thing, lambda member: inspect.isfunction(member) or inspect.ismethod(member))
                is_dataclass = hasattr(thing, "__dataclass_fields__")
                found |= {f"{name}.{m}": f for m, f in methods if not m.startswith("_") or m == "__init__" and not is_dataclass}
    return found


def test_signatures_name_every_keyword():
    calls = public()
    assert {"remesh", "cap", "shapes.coil", "Mover.__init__", "MovingMesh.load", "MovingMesh.refine"} <= calls.keys()
    for name, call in calls.items():
        kinds = {p.kind for p in inspect.signature(call).parameters.values()}
        assert inspect.Parameter.VAR_KEYWORD not in kinds or name in PASSED_ON, name


def test_unknown_keywords_raise_an_error_with_the_closest_known_one():
    for name, call in public().items():
        known = [p.name for p in inspect.signature(call).parameters.values() if p.name != "self"]
        if name in PASSED_ON or not known:
            continue
        for keyword in known:
            wrong = keyword + "s" if keyword + "s" not in known else keyword + "_x"
            with pytest.raises(TypeError, match=f"no keyword '{wrong}': did you mean '"):
                call(**{wrong: 1})
    with pytest.raises(TypeError, match=r"remesh\(\) has no keyword 'min_aes': did you mean 'min_eas'\?"):
        motet.remesh(shapes.box(), min_aes=0.3)
    with pytest.raises(TypeError, match="did you mean 'rigid_layer'"):
        motet.Mover(shapes.box(), rigidlayer=0.3)
    with pytest.raises(TypeError, match="it takes mesh"):
        motet.Refinement(shapes.box(), qqq=1)


def test_load_and_move_have_the_options_of_the_classes():
    new, load = (inspect.signature(call).parameters for call in (motet.MovingMesh, motet.MovingMesh.load))
    others = ("mesh", "path", "progress")
    assert {n: p.default for n, p in new.items() if n not in others} == {n: p.default for n, p in load.items() if n not in others}
    move, mover = (inspect.signature(call).parameters for call in (motet.move, motet.Mover))
    assert all(move[name].default == p.default for name, p in mover.items() if name not in ("mesh", "threads"))


@pytest.mark.parametrize("call", [motet.remesh, motet.mesh, motet.surface, motet.wall])
def test_defaults_are_those_of_the_library(call):
    words = motet._motet.defaults()[call.__name__]
    given = {name: p.default for name, p in inspect.signature(call).parameters.items() if name in words}
    assert len(given) > 6
    for name, default in given.items():
        assert words[name] == default or words[name] in (None, []) and default in (None, ()), name


def handles(folder):
    """Objects of all classes, by how their representations begin."""
    box = shapes.box((2, 2, 2))
    mover = motet.Mover(box)
    with motet.SeriesWriter(folder / "run.pvd") as writer:
        writer.add(0.0, box)
    ball = shapes.ball(2, 2)
    far = ball.copy()
    far.points = far.points + [3.0, 0.0, 0.0]
    contact = motet.Contact({"near": ball, "far": far}, warn=2.0)
    gaps = contact.measure()
    done = motet.remesh(box)
    return {
        "Mesh: 27 points": box, "Mover: 27 points": mover, "PointMover: 27 points": motet.PointMover(box.points, box.points),
        "MovingMesh: step 0": motet.MovingMesh(box), "Refinement: up to 0": motet.Refinement(box), "Contact: 2 surfaces (near, far)": contact,
        "SeriesWriter: ": writer, "Changed: complete": done, "History: vertices 27 -> 27": done.history, "Gaps: least 1": gaps, "Body: ": gaps.bodies["near"],
        "Ahead: first contact": contact.look_ahead(-contact.points * [1.0, 0.0, 0.0]), "Moved: complete": motet.move(box, translate={"xmax": (0.1, 0, 0)}),
        "View at http://127.0.0.1:": motet.view(box),
    }  # fmt: skip


NOT_PICKLED = (motet.Mover, motet.PointMover, motet.MovingMesh, motet.Contact, motet.SeriesWriter, motet.View)


def test_representations_are_short_and_name_the_class(tmp_path):
    for start, handle in handles(tmp_path).items():
        assert repr(handle).startswith(f"motet.{start}"), repr(handle)
        assert len(repr(handle)) < 300


def test_objects_are_equal_after_pickling_or_refuse_it(tmp_path):
    for start, handle in handles(tmp_path).items():
        if isinstance(handle, NOT_PICKLED):
            for store in (pickle.dumps, copy.copy, copy.deepcopy):
                with pytest.raises(TypeError, match=f"motet.{type(handle).__name__} cannot be pickled"):
                    store(handle)
        else:
            assert repr(pickle.loads(pickle.dumps(handle))) == repr(handle), start


def test_pickling_preserves_results_exactly():
    mesh = shapes.box((4, 4, 4))
    mesh.points[62] += 0.12
    done = motet.remesh(mesh, goal="best")
    back = pickle.loads(pickle.dumps(done))
    np.testing.assert_array_equal(back.mesh.points, done.mesh.points)
    assert back.mesh.patch_names == done.mesh.patch_names and back.report == done.report
    field = np.random.default_rng(1).normal(size=mesh.n_cells)
    np.testing.assert_array_equal(back.history.transfer(field, on="cells"), done.history.transfer(field, on="cells"))
    assert back.history.ledger == done.history.ledger


def test_a_refinement_continues_after_pickling():
    original = motet.Refinement(shapes.box((2, 2, 2)))
    original.refine([0, 1, 2])
    loaded = pickle.loads(pickle.dumps(original))
    np.testing.assert_array_equal(loaded.generations, original.generations)
    for one in (original, loaded):
        one.coarsen(np.flatnonzero(one.generations == 1))
    np.testing.assert_array_equal(loaded.mesh.connectivity, original.mesh.connectivity)
    np.testing.assert_array_equal(loaded.mesh.points, shapes.box((2, 2, 2)).points)


@pytest.mark.parametrize("call", [lambda: motet.read("none.vtu"), lambda: motet.remesh(shapes.box(), min_eas=-1), lambda: motet.Mesh([[0]], [])])
def test_pickling_preserves_errors(call):
    with pytest.raises(motet.Error) as error:
        call()
    back = pickle.loads(pickle.dumps(error.value))
    assert type(back) is type(error.value) and str(back) == str(error.value)
    assert (back.what, back.file, back.place, back.remedy) == (error.value.what, error.value.file, error.value.place, error.value.remedy)
