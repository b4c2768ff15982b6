"""The cases of testdata: the interfaces in Rust, Python, C, C++ and Fortran give the same numbers."""
import os
import tomllib
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Program

motet = pytest.importorskip("motet", reason="the package is not installed: ./test does it")
CLIENTS = Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target") / "capi" / "clients"
CLIENTS_OF_C = ("cases_c", "cases_cpp", "cases_f")
CASES = sorted((ROOT / "testdata").glob("*.toml"))


def made(shape, scale=1.0, **options):
    mesh = getattr(motet.shapes, shape)(**options)
    mesh.points = mesh.points * scale
    return mesh


def numbers(lines):
    return {name: float(value) for name, value in (line.split() for line in lines.splitlines())}


def mesh_numbers(mesh):
    # Sequential sums, as in the other languages.
    x, y, z = (np.cumsum(column)[-1] for column in mesh.points.T)
    worst = np.nanmin(mesh.quality())
    return {"points": mesh.n_points, "tets": len(mesh.tets), "sum_x": x, "sum_y": y, "sum_z": z, "worst_eas": worst}


def repair(path, patch, dx, dy, dz, smooth):
    mesh = motet.read(path)
    moved = motet.move(mesh, translate={patch: [float(dx), float(dy), float(dz)]}, smooth=int(smooth))
    certificate = moved.certificate
    done = motet.remesh(moved.mesh)
    carried = done.history.transfer(moved.mesh.points[:, 0], on="points")
    return {
        "complete": certificate.complete, "bad_after_motion": certificate.bad, "worst_after_motion": certificate.worst_eas.value,
        "repaired": done.complete, **mesh_numbers(done.mesh), "sum_carried": np.cumsum(carried)[-1],
    }  # fmt: skip


def implant(host, device, name):
    done = motet.implant(host, {name: device})
    labels = {label: name for name, label in done.mesh.region_names.items()}
    return {"complete": done.complete, "region": labels[name], **mesh_numbers(done.mesh)}


def contact(first, second):
    gaps = motet.Contact({"first": surface(first), "second": surface(second)}).measure()
    gap = np.concatenate([body.gap for body in gaps.bodies.values()])
    return {"least": gaps.least, "sum_of_gaps": np.cumsum(gap[np.isfinite(gap)])[-1]}


def loop(path, patch, dx, dy, dz, steps):
    mesh, n_steps, x, changes = motet.read(path), int(steps), None, 0
    options = {"smooth": 2}
    moving = motet.MovingMesh(mesh, **options)
    places = moving.driven_places
    in_patch = {tuple(point) for point in mesh.points[mesh.patch_vertices(patch)]}
    shifts = np.array([[float(dx), float(dy), float(dz)] if tuple(place) in in_patch else [0.0] * 3 for place in places])
    x = np.array(mesh.points[:, 0])
    for k in range(1, 2 * n_steps + 1):
        changes += len(moving.advance(k, min(k, 2 * n_steps - k) / n_steps * shifts).changes)
        if history := moving.history_since(k - 1):
            x = history.transfer(x, on="points")
        if k == n_steps:
            moving.save(f"{path}.state.vtu")
            moving = motet.MovingMesh.load(f"{path}.state.vtu", **options)
    velocity = np.cumsum(moving.velocity[:, 0])[-1]
    return {"changes": changes, "time": moving.time, "sum_velocity": velocity, "sum_carried": np.cumsum(x)[-1], **mesh_numbers(moving.mesh)}


def surface(path):
    mesh = motet.read(path)
    return motet.Mesh(mesh.points, {"triangle": mesh.triangles})


PYTHON = {"repair": repair, "implant": implant, "contact": contact, "loop": loop}


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_every_interface_gives_the_same_numbers(path, tmp_path, example):
    case = tomllib.loads(path.read_text())
    files = []
    for k, shape in enumerate(case["meshes"]):
        files.append(tmp_path / f"{k}.vtu")
        made(**shape).save(files[-1])
    arguments = [*files, *case["words"]]
    results = {"Rust": numbers(example("cases")(case["program"], *arguments).stdout)}
    results["Python"] = {name: float(value) for name, value in PYTHON[case["program"]](*map(str, arguments)).items()}
    for client in CLIENTS_OF_C:
        if (CLIENTS / client).exists():
            results[client] = numbers(Program(CLIENTS / client)(case["program"], *arguments).stdout)
    for interface, values in results.items():
        assert values == results["Rust"], interface
    for name, value in case["expected"].items():
        assert results["Rust"][name] == pytest.approx(value, rel=1e-9), name
    for name, value in case["about"].items():
        assert results["Rust"][name] == pytest.approx(value, rel=0.02), name


def test_the_clients_in_c_cpp_and_fortran_are_built():
    missing = [client for client in CLIENTS_OF_C if not (CLIENTS / client).exists()]
    if missing and os.environ.get("MOTET_TEST_STRICT") != "1":
        pytest.skip(f"{', '.join(missing)} not built: crates/motet-capi/check")
    assert not missing
