"""Hosts and devices of the implantation benchmark in the formats of all programs, and measures of the
results."""
import subprocess

import numpy as np

from common import MOTET, TARGET
from mesh_files import DATA, merged, read_vtp
from remesh_files import made, read_vtu
from sameness import compared, kept, matched
from tets import EDGES, FACETS, boundary, measures, volumes

WITHIN_ROUNDING = 1e-9
PUBLIC = DATA / "vessels" / "vmtk_id1_aneurysm.vtp"


def shapes(quick):
    """Create motet's built-in shapes and the hosts meshed from them. Not timed."""
    folder = TARGET / "implant_shapes"
    folder.mkdir(exist_ok=True)
    subprocess.run([MOTET / "examples" / "shapes", folder], check=True)
    if not quick:
        quietly("mesh", folder / "aneurysm.vtp", "-o", folder / "aneurysm.vtu", "--size", "0.15")
    return folder


def cases(quick):
    """Return the cases, and the names of those without data."""
    own = shapes(quick)
    found = [Case("coil in a box", own / "block.vtu", [own / "turns.vtp"], 0.12, ["--growth", "0.4"])]
    if quick:
        return found, []
    found.append(Case("coil in an aneurysm", own / "aneurysm.vtu", [own / "loops.vtp"], 0.075))
    found.append(Case("stent through the wall", own / "aneurysm.vtu", [own / "stent.vtp"], 0.06))
    found.append(Case("coil and stent", own / "aneurysm.vtu", [own / "loops.vtp", own / "stent.vtp"], 0.06))
    if not PUBLIC.is_file():
        return found, ["coil in a public aneurysm"]
    host, coil = own / "public.vtu", own / "public_coil.vtp"
    quietly("mesh", PUBLIC, "-o", host, "--repair", "--hole-edges", "200", "--size", "auto")
    subprocess.run([MOTET / "examples" / "coil", coil, "--at", "50.4,47.2,41.4", "--radius", "2"], check=True)
    return [*found, Case("coil in a public aneurysm", host, [coil], 0.15)], []


def quietly(*arguments):
    """Run motet; bad tets in the result are not an error."""
    done = subprocess.run([MOTET / "motet", *arguments, "-q"])
    if done.returncode not in (0, 4):
        raise SystemExit(f"motet {' '.join(map(str, arguments))}: exit status {done.returncode}")


class Case:
    """A host, devices, and their files: `host` and `devices` for motet, `npz` for the others."""

    def __init__(self, name, host, devices, wire, options=()):
        """`wire` is half the thickness of the devices; `options` are those of `motet implant`."""
        self.name, self.host, self.devices, self.options = name, host, devices, options
        self.folder = TARGET / f"implant_{''.join(letter for letter in name if letter.isalpha() or letter == ' ').replace(' ', '_')}"
        self.folder.mkdir(exist_ok=True)
        for path in self.folder.iterdir():
            path.unlink()
        self.host_points, self.host_tets = read_vtu(host)
        self.host_bad = measures(self.host_points, self.host_tets)["bad"]
        surfaces = [merged(self.host_points, boundary(self.host_tets)), *(merged(*read_vtp(device)) for device in devices)]
        first = np.cumsum([0, *(len(points) for points, _ in surfaces)])
        self.points = np.concatenate([points for points, _ in surfaces])
        self.triangles = np.concatenate([triangles + start for (_, triangles), start in zip(surfaces, first)])
        self.part = np.repeat(np.arange(len(surfaces)), [len(triangles) for _, triangles in surfaces])
        corners = self.host_points[self.host_tets]
        edge = np.linalg.norm(corners[:, EDGES[:, 0]] - corners[:, EDGES[:, 1]], axis=2).mean()
        background_points, background_tets = self.background(wire)
        self.npz = self.folder / "in.npz"
        np.savez(self.npz, points=self.points, triangles=self.triangles, part=self.part, wire=wire, edge=edge,
                 background_points=background_points, background_tets=background_tets)
        self.device = self.triangles[self.part > 0]
        self.surface = self.triangles[self.part == 0]

    def background(self, size):
        """Refine the host for a level set: edges no longer than the size plus their distance from the
        devices."""
        path = self.folder / "background.vtu"
        near = [argument for device in self.devices for argument in ("--near-size", f"{device}={size},1")]
        quietly("refine", self.host, "-o", path, *near)
        return read_vtu(path)

    def out(self, program, end):
        return self.folder / ("".join(letter if letter.isalnum() else "_" for letter in program) + end)

    def measured(self, path, regions):
        """Measure the quality of a program's mesh, and how much of the devices and of the host it kept."""
        points, tets = made(path)
        if volumes(points, tets).sum() < 0:  # TetGen's tets have the opposite orientation
            tets = tets[:, [1, 0, 2, 3]]
        row, to_the_bit = matched(self.points, np.ascontiguousarray(points, np.float64) + 0.0)  # no negative zeros
        found, _ = kept(self.device, tets[:, FACETS].reshape(-1, 3), row, to_the_bit)
        in_device = self.in_device(path, regions, points, tets)
        apart = self.apart(points, tets, in_device)
        host = compared(self.host_points, self.host_tets, points, tets)["kept"]
        return {**measures(points, tets), "in_device": int(in_device.sum()), "triangles": len(self.device), "triangles_found": found,
                "apart": apart, "host_kept": host, "volume_off": float(volumes(points, tets).sum() / volumes(self.host_points, self.host_tets).sum() - 1)}

    def in_device(self, path, regions, points, tets):
        """Return which tets belong to devices, by the program's output or by winding numbers of their
        centroids."""
        if path.suffix == ".vtu":
            return np.isin(region_of_tets(path), regions)
        written = np.load(path)
        return written["in_device"] if "in_device" in written else winding(self.points, self.device, points[tets].mean(axis=1)) > 0.5

    def apart(self, points, tets, in_device):
        """Return the largest distance, in both directions, between devices inside the host and
        the interface."""
        bounds = boundary(tets[in_device])
        interface = without(bounds, boundary(tets))
        if len(interface) == 0:
            return None
        samples = sampled(self.points, self.device)
        samples = samples[winding(self.points, self.surface, samples) > 0.5]
        to_interface = distances(samples, points, bounds)
        to_device = distances(sampled(points, interface), self.points, self.device)
        largest = float(max(to_interface.max(), to_device.max()))
        return 0.0 if largest < WITHIN_ROUNDING * np.ptp(self.points) else largest


def region_of_tets(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    return vtk_to_numpy(grid.GetCellData().GetArray("region"))[vtk_to_numpy(grid.GetCellTypes()) == vtk.VTK_TETRA]


def winding(points, triangles, places):
    import igl

    return igl.fast_winding_number(points, triangles.astype(np.int64), np.ascontiguousarray(places))


def sampled(points, triangles):
    """Return the corners, edge midpoints and centroids of triangles."""
    corners = points[triangles]
    middles = (corners + corners[:, [1, 2, 0]]) / 2
    return np.concatenate([points[np.unique(triangles)], middles.reshape(-1, 3), corners.mean(axis=1)])


def distances(places, points, triangles):
    import igl

    points = np.ascontiguousarray(points, np.float64)
    return np.sqrt(igl.point_mesh_squared_distance(places, points, triangles.astype(np.int64))[0])


def without(facets, others):
    """Return the facets that are not among the others."""
    key = lambda rows: np.sort(rows, axis=1).astype(np.int64) @ [1 << 42, 1 << 21, 1]  # up to two million vertices
    return facets[~np.isin(key(facets), key(others))]
