"""Invalid numbers raise an error in every call, and never give a result, a panic or an abort."""
import inspect
import math
import re
import tempfile
from pathlib import Path

import numpy as np
import pytest
from test_keywords import public

import motet
from motet import shapes

NAN, INF, HUGE = math.nan, math.inf, 1e120
LENGTH = (NAN, INF, -1.0, HUGE)
# Infinity means no limit.
REACH = (NAN, -1.0)
PART = (NAN, INF, -1.0, HUGE)
COUNT = (NAN, INF, -1, -1.0)


def saved():
    path = Path(tempfile.mkdtemp()) / "box.vtu"
    shapes.box((1, 1, 1)).save(path)
    return path


def near():
    return [(shapes.ball(1, 1), 0.1)]


def open_vessel():
    whole = shapes.aneurysm()
    return motet.Mesh(whole.points, whole.triangles[whole.cell_data["patch"] == 1])


def moved(**options):
    return lambda value: motet.move(shapes.box((2, 2, 2)), translate={"xmax": (0.1, 0.0, 0.0)}, **{name: make(value) for name, make in options.items()})


def mover(**options):
    return lambda value: motet.Mover(shapes.box((2, 2, 2)), **{name: make(value) for name, make in options.items()})


def moving(**options):
    return lambda value: motet.MovingMesh(shapes.box((2, 2, 2)), **{name: make(value) for name, make in options.items()})


def unchanged(value):
    return value


def always(constant):
    return lambda _: constant


# For each option of each call: a call with it, and its invalid values.
OPTIONS = {
    "remesh.min_eas": (lambda x: motet.remesh(shapes.box(), min_eas=x), PART),
    "remesh.min_dihedral_deg": (lambda x: motet.remesh(shapes.box(), min_dihedral_deg=x), PART),
    "remesh.distance": (lambda x: motet.remesh(shapes.box(), surface="adapt", distance=x), LENGTH),
    "remesh.sizes": (lambda x: motet.remesh(shapes.box(), sizes=x), LENGTH),
    "remesh.sizes of points": (lambda x: motet.remesh(shapes.box(), sizes=np.full(125, x)), LENGTH),
    "remesh.rounds": (lambda x: motet.remesh(shapes.box(), rounds=x), COUNT),
    "view.port": (lambda x: motet.view(shapes.box(), port=x), (*COUNT, 65536)),
    "view.threads": (lambda x: motet.view(shapes.box(), threads=x), COUNT),
    "remesh.threads": (lambda x: motet.remesh(shapes.box(), threads=x), COUNT),
    "implant.tolerance": (lambda x: motet.implant(shapes.box(), shapes.coil(), interface="conform", tolerance=x), LENGTH),
    "implant.stray": (lambda x: motet.implant(shapes.box(), shapes.coil(), stray=x), LENGTH),
    "implant.size": (lambda x: motet.implant(shapes.box(), shapes.coil(), size=x), LENGTH),
    "implant.growth": (lambda x: motet.implant(shapes.box(), shapes.coil(), growth=x), LENGTH),
    "implant.carve": (lambda x: motet.implant(shapes.box(), shapes.coil(), carve=x), LENGTH),
    "implant.reach": (lambda x: motet.implant(shapes.box(), shapes.coil(), reach=x), LENGTH),
    "implant.min_eas": (lambda x: motet.implant(shapes.box(), shapes.coil(), min_eas=x), PART),
    "implant.threads": (lambda x: motet.implant(shapes.box(), shapes.coil(), threads=x), COUNT),
    "surface.size": (lambda x: motet.surface(shapes.aneurysm(), size=x), LENGTH),
    "surface.distance": (lambda x: motet.surface(shapes.aneurysm(), distance=x), LENGTH),
    "surface.feature_angle": (lambda x: motet.surface(shapes.aneurysm(), feature_angle=x), (-1.0, 181.0, NAN)),
    "surface.growth": (lambda x: motet.surface(shapes.aneurysm(), growth=x), LENGTH),
    "surface.wrap": (lambda x: motet.surface(shapes.aneurysm(), wrap=x), (*LENGTH, 1e-9)),
    "surface.merge": (lambda x: motet.surface(shapes.aneurysm(), repair=True, merge=x), LENGTH),
    "surface.hole_edges": (lambda x: motet.surface(shapes.aneurysm(), repair=True, hole_edges=x), COUNT),
    "surface.smooth": (lambda x: motet.surface(shapes.aneurysm(), smooth=x), COUNT),
    "cap.extend": (lambda x: motet.cap(open_vessel(), extend=x), LENGTH),
    "wall.thickness": (lambda x: motet.wall(shapes.tube(), thickness=x), LENGTH),
    "wall.of_radius": (lambda x: motet.wall(shapes.tube(), of_radius=x), LENGTH),
    "wall.layers": (lambda x: motet.wall(shapes.tube(), thickness=0.1, layers=x), (*COUNT, 0)),
    "wall.growth": (lambda x: motet.wall(shapes.tube(), thickness=0.1, growth=x), LENGTH),
    "wall.threads": (lambda x: motet.wall(shapes.tube(), thickness=0.1, threads=x), COUNT),
    "surface.tubes": (lambda x: motet.surface(shapes.braid(wires=2, length=1), tubes=x), LENGTH),
    "surface.sides": (lambda x: motet.surface(shapes.braid(wires=2, length=1), tubes=0.05, sides=x), (*COUNT, 2, 361)),
    "surface.join": (lambda x: motet.surface(shapes.braid(wires=2, length=1), tubes=0.05, join=x), (NAN, INF, -1.0)),
    "surface.threads": (lambda x: motet.surface(shapes.aneurysm(), threads=x), COUNT),
    "mesh.size": (lambda x: motet.mesh(shapes.aneurysm(), size=x), LENGTH),
    "mesh.distance": (lambda x: motet.mesh(shapes.aneurysm(), size=0.5, surface="adapt", distance=x), LENGTH),
    "mesh.feature_angle": (lambda x: motet.mesh(shapes.aneurysm(), size=0.5, surface="adapt", feature_angle=x), (-1.0, 181.0, NAN)),
    "mesh.growth": (lambda x: motet.mesh(shapes.aneurysm(), size="auto", growth=x), LENGTH),
    "mesh.min_eas": (lambda x: motet.mesh(shapes.aneurysm(), size=0.5, min_eas=x), PART),
    "mesh.layers": (lambda x: motet.mesh(shapes.aneurysm(), layers=(2, x, 1.2)), LENGTH),
    "mesh.layers, growth": (lambda x: motet.mesh(shapes.aneurysm(), layers=(2, 0.01, x)), LENGTH),
    "mesh.layers, count": (lambda x: motet.mesh(shapes.aneurysm(), layers=(x, 0.01, 1.2)), (*COUNT, 10**9)),
    "mesh.holes": (lambda x: motet.mesh(shapes.aneurysm(), holes=[(x, 0.0, 0.0)]), (NAN, INF, HUGE)),
    "mesh.seeds": (lambda x: motet.mesh(shapes.aneurysm(), seeds={"a": (x, 0.0, 0.0)}), (NAN, INF, HUGE)),
    "mesh.wrap": (lambda x: motet.mesh(shapes.aneurysm(), wrap=x), (*LENGTH, 1e-9)),
    "mesh.merge": (lambda x: motet.mesh(shapes.aneurysm(), repair=True, merge=x), LENGTH),
    "mesh.hole_edges": (lambda x: motet.mesh(shapes.aneurysm(), repair=True, hole_edges=x), COUNT),
    "mesh.threads": (lambda x: motet.mesh(shapes.aneurysm(), threads=x), COUNT),
    "refine.near": (lambda x: motet.refine(shapes.box(), near=[(shapes.ball(1, 1), x)]), LENGTH[:3]),
    "refine.near_size": (lambda x: motet.refine(shapes.box(), near_size=[(shapes.ball(1, 1), x)]), LENGTH[:3]),
    "refine.near_size, growth": (lambda x: motet.refine(shapes.box(), near_size=[(shapes.ball(1, 1), 0.5, x)]), LENGTH[:3]),
    "refine.box": (lambda x: motet.refine(shapes.box(), box=[((0, 0, 0), (x, 1, 1))]), (NAN, INF)),
    "refine.ball": (lambda x: motet.refine(shapes.box(), ball=[((0, 0, 0), x)]), LENGTH[:3]),
    "refine.ball, centre": (lambda x: motet.refine(shapes.box(), ball=[((x, 0, 0), 1.0)]), (NAN, INF, HUGE)),
    "refine.patch": (lambda x: motet.refine(shapes.box(), patch=[("xmin", x)]), LENGTH[:3]),
    "refine.size": (lambda x: motet.refine(shapes.box(), size=x), (NAN, INF, -1.0)),
    "refine.where": (lambda x: motet.refine(with_p(), where=[f"p>{x}"]), (NAN,)),
    "refine.gradient": (lambda x: motet.refine(with_p(), gradient=[f"p>{x}"]), (NAN, INF)),
    "refine.jump": (lambda x: motet.refine(with_p(), jump={"p": float(x)}), PART),
    "refine.recovery": (lambda x: motet.refine(with_p(), recovery={"p": float(x)}), PART),
    "refine.hessian": (lambda x: motet.refine(with_p(), hessian={"p": float(x)}), (NAN, INF, -1.0)),
    "refine.generations": (lambda x: motet.refine(shapes.box(), everything=True, generations=x), COUNT),
    "refine.limit_generation": (lambda x: motet.refine(shapes.box(), everything=True, limit_generation=x), (*COUNT, 1000)),
    "refine.smallest": (lambda x: motet.refine(shapes.box(), everything=True, smallest=x), (NAN, -1.0)),
    "refine.at_most": (lambda x: motet.refine(shapes.box(), everything=True, at_most=x), COUNT),
    "refine.threads": (lambda x: motet.refine(shapes.box(), everything=True, threads=x), COUNT),
    "move.translate": (lambda x: motet.move(shapes.box(), translate={"xmax": (x, 0, 0)}), (NAN, INF, HUGE)),
    "move.rotate": (lambda x: motet.move(shapes.box(), rotate={"xmax": ((0, 0, 1), x)}), (NAN, INF)),
    "move.rotate, axis": (lambda x: motet.move(shapes.box(), rotate={"xmax": ((x, 0, 1), 5)}), (NAN, INF)),
    "move.displacement": (lambda x: motet.move(shapes.box(), displacement=np.full((125, 3), x)), (NAN, INF, HUGE)),
    "move.steps": (moved(steps=unchanged), COUNT),
    "move.least": (moved(method=always("auto"), least=unchanged), PART),
    "Mover.smooth": (mover(smooth=unchanged), COUNT),
    "Mover.rigid_layer": (mover(rigid_layer=unchanged), LENGTH),
    "Mover.rigid_layer_cells": (mover(rigid_layer_cells=unchanged), COUNT),
    "Mover.slide_tolerance": (mover(slide_tolerance=unchanged), PART),
    "Mover.residual": (mover(method=always("laplace"), residual=unchanged), PART),
    "Mover.factor_gib": (mover(method=always("laplace"), factor_gib=unchanged), REACH),
    "Mover.factor_gib, unused": (mover(factor_gib=unchanged), REACH),
    "Mover.substeps": (mover(substeps=unchanged), COUNT),
    "Mover.threads": (mover(threads=unchanged), COUNT),
    "Mover.also_moved": (lambda x: motet.Mover(shapes.box(), also_moved=[x]), COUNT),
    "PointMover.threads": (lambda x: motet.PointMover(shapes.box().points, shapes.box().points, threads=x), COUNT),
    "PointMover.nodes": (lambda x: motet.PointMover(np.full((9, 3), x), shapes.box().points), (NAN, INF, HUGE)),
    "PointMover.points": (lambda x: motet.PointMover(shapes.box().points, np.full((9, 3), x)), (NAN, INF, HUGE)),
    "Mover.step.displacement": (lambda x: stepped(x), (NAN, INF)),
    "Mover.advance.displacement": (lambda x: advanced(x), (NAN, INF, HUGE)),
    "MovingMesh.smooth": (moving(smooth=unchanged), COUNT),
    "MovingMesh.rigid_layer": (moving(rigid_layer=unchanged), LENGTH),
    "MovingMesh.rigid_layer_cells": (moving(rigid_layer_cells=unchanged), COUNT),
    "MovingMesh.slide_tolerance": (moving(slide_tolerance=unchanged), PART),
    "MovingMesh.min_eas": (moving(min_eas=unchanged), PART),
    "MovingMesh.distance": (moving(surface=always("adapt"), distance=unchanged), LENGTH),
    "MovingMesh.margin": (moving(margin=unchanged), PART),
    "MovingMesh.floor": (moving(floor=unchanged), PART),
    "MovingMesh.improve_below": (moving(improve_below=unchanged), PART),
    "MovingMesh.warn": (moving(watch=always(["xmin", "xmax"]), warn=unchanged), REACH),
    "MovingMesh.within": (moving(watch=always(["xmin", "xmax"]), within=unchanged), REACH),
    "MovingMesh.horizon": (moving(watch=always(["xmin", "xmax"]), horizon=unchanged), REACH),
    "MovingMesh.hold": (moving(watch=always(["xmin", "xmax"]), hold=unchanged), LENGTH),
    "MovingMesh.remembered": (moving(remembered=unchanged), COUNT),
    "MovingMesh.threads": (moving(threads=unchanged), COUNT),
    "MovingMesh.advance.time": (lambda x: moved_on(x, 0.0), (NAN, INF, -1.0)),
    "MovingMesh.advance.displacement": (lambda x: moved_on(1.0, x), (NAN, INF, HUGE)),
    "MovingMesh.refine.size": (lambda x: motet.MovingMesh(shapes.box()).refine(size=x), (NAN, INF, -1.0)),
    "MovingMesh.refine.generations": (lambda x: motet.MovingMesh(shapes.box()).refine(everything=True, generations=x), COUNT),
    "MovingMesh.coarsen.smallest": (lambda x: motet.MovingMesh(shapes.box()).coarsen(smallest=x), REACH),
    "MovingMesh.remembers.step": (lambda x: motet.MovingMesh(shapes.box()).remembers(x), COUNT),
    "MovingMesh.history_since.step": (lambda x: motet.MovingMesh(shapes.box()).history_since(x), COUNT),
    "Contact.warn": (lambda x: motet.Contact(balls(), warn=x), REACH),
    "Contact.within": (lambda x: motet.Contact(balls(), within=x), REACH),
    "Contact.fold": (lambda x: motet.Contact(balls(), fold=x), REACH),
    "Contact.threads": (lambda x: motet.Contact(balls(), threads=x), COUNT),
    "Contact.refit.points": (lambda x: motet.Contact(balls()).refit(np.full_like(motet.Contact(balls()).points, x)), (NAN, INF)),
    "Contact.look_ahead.velocity": (lambda x: motet.Contact(balls()).look_ahead(np.full_like(motet.Contact(balls()).points, x)), (NAN, INF)),
    "Contact.look_ahead.horizon": (lambda x: motet.Contact(balls()).look_ahead(np.ones_like(motet.Contact(balls()).points), horizon=x), REACH),
    "Contact.look_ahead_to.dt": (lambda x: motet.Contact(balls()).look_ahead_to(motet.Contact(balls()).points, x), (NAN, INF, -1.0)),
    "read.threads": (lambda x: motet.read(saved(), threads=x), COUNT),
    "Mesh.save.threads": (lambda x: shapes.box((1, 1, 1)).save(saved(), threads=x), COUNT),
    "SeriesWriter.add.threads": (lambda x: motet.SeriesWriter(saved().with_suffix(".pvd")).add(0.0, shapes.box((1, 1, 1)), threads=x), COUNT),
    "Refinement.threads": (lambda x: motet.Refinement(shapes.box(), threads=x), COUNT),
    "Refinement.refine.cells": (lambda x: motet.Refinement(shapes.box()).refine([x]), (NAN, -1)),
    "mesh_velocity.dt": (lambda x: motet.mesh_velocity(shapes.box().points, shapes.box().points, x), (NAN, INF, -1.0, 0.0)),
    "shapes.box.n": (lambda x: shapes.box((x, 1, 1)), (*COUNT, 0, 10**9, 2**63)),
    "shapes.box.low": (lambda x: shapes.box(low=(x, 0, 0)), (NAN, INF, -INF, HUGE)),
    "shapes.box.high": (lambda x: shapes.box(high=(x, 1, 1)), LENGTH),
    "shapes.ball.n": (lambda x: shapes.ball(x), (*COUNT, 0, 10**6, 2**63)),
    "shapes.ball.layers": (lambda x: shapes.ball(1, x), (*COUNT, 0, 10**9, 2**63)),
    "shapes.sphere_in_box.n": (lambda x: shapes.sphere_in_box(x), (*COUNT, 0, 10**6, 2**63)),
    "shapes.sphere_in_box.layers": (lambda x: shapes.sphere_in_box(1, x), (*COUNT, 0, 10**9, 2**63)),
    "shapes.mixed.n": (lambda x: shapes.mixed(x), (*COUNT, 0, 10**6, 2**63)),
    "shapes.tube.radius": (lambda x: shapes.tube(radius=x), LENGTH),
    "shapes.tube.length": (lambda x: shapes.tube(length=x), LENGTH),
    "shapes.tube.n": (lambda x: shapes.tube(n=x), (*COUNT, 0, 10**6, 2**63)),
    "shapes.tube.slices": (lambda x: shapes.tube(slices=x), (*COUNT, 0, 10**9, 2**63)),
    "shapes.tube.wall_layers": (lambda x: shapes.tube(wall_layers=x), (*COUNT, 10, 10**9, 2**63)),
    "shapes.aneurysm.around": (lambda x: shapes.aneurysm(around=x), (*COUNT, 0, 10**9, 2**63)),
    "shapes.aneurysm.bend_deg": (lambda x: shapes.aneurysm(bend_deg=x), (NAN, INF, HUGE)),
    "shapes.stent.radius": (lambda x: shapes.stent(x), LENGTH),
    "shapes.stent.length": (lambda x: shapes.stent(length=x), LENGTH),
    "shapes.stent.rings": (lambda x: shapes.stent(rings=x), (*COUNT, 0, 10**9, 2**63)),
    "shapes.stent.crowns": (lambda x: shapes.stent(crowns=x), (*COUNT, 0, 10**9, 2**63)),
    "shapes.stent.strut_width": (lambda x: shapes.stent(strut_width=x), LENGTH),
    "shapes.stent.thickness": (lambda x: shapes.stent(thickness=x), LENGTH),
    "shapes.braid.radius": (lambda x: shapes.braid(x), LENGTH),
    "shapes.braid.length": (lambda x: shapes.braid(length=x), LENGTH),
    "shapes.braid.wires": (lambda x: shapes.braid(wires=x), (*COUNT, 0, 3, 10**9, 2**63)),
    "shapes.braid.pitch": (lambda x: shapes.braid(pitch=x), LENGTH),
    "shapes.braid.wire_radius": (lambda x: shapes.braid(wire_radius=x), LENGTH),
    "shapes.braid.gap": (lambda x: shapes.braid(gap=x), (NAN, INF, HUGE)),
    "shapes.braid.over": (lambda x: shapes.braid(over=x), (*COUNT, 0, 3)),
    "shapes.braid.steps": (lambda x: shapes.braid(steps=x), (*COUNT, 0, 10**9, 2**63)),
    "shapes.coil.centre": (lambda x: shapes.coil((x, 0, 0)), (NAN, INF, HUGE)),
    "shapes.coil.radius": (lambda x: shapes.coil(radius=x), (NAN, INF, HUGE)),
    "shapes.coil.pitch": (lambda x: shapes.coil(pitch=x), (NAN, INF, HUGE)),
    "shapes.coil.turns": (lambda x: shapes.coil(turns=x), (*LENGTH, 1e9)),
    "shapes.coil.wire_radius": (lambda x: shapes.coil(wire_radius=x), LENGTH),
    "shapes.coil.steps": (lambda x: shapes.coil(steps=x), (*COUNT, 10**9, 2**63)),
    "shapes.coil.around": (lambda x: shapes.coil(around=x), (*COUNT, 0, 10**9, 2**63)),
    "shapes.coil.turns of no sides": (lambda x: shapes.coil(turns=x, around=0), (1e9, 1e15)),
}
# Options that are checked by the code of another call above.
SAME = {f"move.{name}" for name in ("smooth", "slide_tolerance", "rigid_layer", "rigid_layer_cells", "residual", "factor_gib", "substeps", "threads", "also_moved")}
SAME |= {f"MovingMesh.load.{key.removeprefix('MovingMesh.')}" for key in OPTIONS if key.startswith("MovingMesh.") and key.count(".") == 1}
SAME |= {f"MovingMesh.refine.{key.removeprefix('refine.')}" for key in OPTIONS if key.startswith("refine.")} | {"MovingMesh.refine.hessian"}
# Every number is valid.
FREE = {"Mover.weights.vertex", "SeriesWriter.add.time", "write_nodal.times", "refine.hessian"}


def with_p():
    mesh = shapes.box()
    mesh.point_data["p"] = mesh.points[:, 0] ** 2
    return mesh


def balls():
    one, two = shapes.ball(1, 1), shapes.ball(1, 1)
    two.points = two.points + [3.0, 0.0, 0.0]
    return [one, two]


def stepped(value):
    mover = motet.Mover(shapes.box((2, 2, 2)))
    return mover.step(np.full((len(mover.boundary), 3), value))


def advanced(value):
    mover = motet.Mover(shapes.box((2, 2, 2)))
    return mover.advance(np.full((len(mover.boundary), 3), value))


def moved_on(time, value):
    mesh = motet.MovingMesh(shapes.box((2, 2, 2)))
    return mesh.advance(time, np.full(mesh.driven_places.shape, value))


@pytest.mark.parametrize("option", OPTIONS)
def test_invalid_numbers_raise_an_error(option):
    call, wrong = OPTIONS[option]
    for value in wrong:
        # Python itself rejects values that are not integers.
        with pytest.raises((motet.Error, TypeError, OverflowError, ValueError)) as error:
            call(value)
        assert not isinstance(error.value, motet.InternalError), error.value


def test_every_numeric_parameter_is_tested():
    for name, call in public().items():
        name = name.removesuffix(".__init__")
        for keyword, parameter in inspect.signature(call).parameters.items():
            kind = re.sub(r"str \| int|Mapping\[int, str\]", "", str(parameter.annotation))
            if keyword != "self" and re.search(r"\b(int|float)\b", kind):
                key = f"{name}.{keyword}"
                assert key in OPTIONS or key in SAME | FREE, f"{key}: {kind}"


def test_non_finite_points_are_reported_and_refused():
    mesh = shapes.box((1, 1, 1))
    mesh.points[0] = NAN
    assert any(defect.name == "non_finite_point" for defect in mesh.summary().defects)
    for call in (motet.remesh, motet.Mover, motet.MovingMesh, motet.Refinement):
        with pytest.raises(motet.InputError):
            call(mesh)
