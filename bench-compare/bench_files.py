"""Reading and writing of a VTU file of a million tets, by motet and by VTK."""
import sys

from common import HERE, MOTET, TARGET, call, cell, in_turn, seconds_text, table

CUBES = 55  # 6 * 55^3 = 998,250 tets


def run(record, options):
    folder = TARGET / "files"
    folder.mkdir(parents=True, exist_ok=True)
    vtk = [sys.executable, HERE / "rivals" / "files_vtk.py"]
    motet = [MOTET / "examples" / "vtu_io"]
    plain = folder / "million_none.vtu"
    made = call([*vtk, "make", plain, CUBES], limit=options.limit)
    if "error" in made:
        sys.exit(f"VTK could not make the file: {made['error']}")
    packed = folder / "million_zlib.vtu"
    call([*vtk, "write", plain, packed, "zlib", 1], limit=options.limit)
    runs, rows = 3, []
    for compression, path in (("none", plain), ("zlib", packed)):
        for verb in ("read", "write"):
            arguments = [path, runs] if verb == "read" else [plain, None, compression, runs]
            command = lambda program, out: [*program, verb, *[out if a is None else a for a in arguments]]
            results = in_turn({"motet": command(motet, folder / "out_motet.vtu"),
                               "VTK": command(vtk, folder / "out_vtk.vtu")}, options.rounds, limit=options.limit)
            for program, result in results.items():
                record.add(bench="files", verb=verb, compression=compression, program=program, **result)
            sizes = [f"{p.stat().st_size / 2**20:.1f}" if p.exists() else "-"
                     for p in ([path] * 2 if verb == "read" else [folder / "out_motet.vtu", folder / "out_vtk.vtu"])]
            ours, theirs = results["motet"], results["VTK"]
            rows.append([f"{verb}, {compression}", shown(ours), shown(theirs),
                         f"{theirs['seconds'] / ours['seconds']:.2f}" if "seconds" in ours and "seconds" in theirs else "-",
                         "1", *sizes])
        print(f"  {compression}: done", file=sys.stderr, flush=True)
    print("\n## A VTU file of a million tets\n")
    print(f"{6 * CUBES**3:,} tets, {(CUBES + 1) ** 3:,} points, raw appended; medians over {options.rounds} rounds in turn;"
          " the file is in the system's cache, and written files are not synchronised to disk.\n")
    print(table(["", "motet", "VTK", "VTK/motet", "target", "motet MiB", "VTK MiB"], rows))


def shown(result):
    return cell(result, seconds_text(result.get("seconds")))
