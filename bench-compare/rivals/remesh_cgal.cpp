// CGAL's tetrahedral isotropic remeshing, boundaries kept, one thread: Medit file in, points and tets out, JSON out.
// usage: remesh_cgal IN.mesh ROUNDS LENGTH OUT
//
// The file holds a triangulated box: subdomain 1 is the mesh, 2 fills its cavity, since CGAL wants all of the space
// around. Only subdomain 1 is remeshed. CGAL 6 keeps the edge lengths that are there; older ones want edges of LENGTH
// everywhere. Writes OUT.points and OUT.tets, without subdomain 2.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/File_medit.h>
#include <CGAL/Tetrahedral_remeshing/Remeshing_triangulation_3.h>
#include <CGAL/tetrahedral_remeshing.h>
#include <CGAL/version.h>
#if CGAL_VERSION_NR >= 1060000000
#include <CGAL/Adaptive_remeshing_sizing_field.h>
#endif

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <unordered_map>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Tetrahedral_remeshing::Remeshing_triangulation_3<Kernel>;
using Cell = Triangulation::Cell_handle;
enum { MESH = 1, CAVITY = 2 };

// Which cells may be changed: asked as a function up to CGAL 5, as a property map later; new cells belong to the mesh.
struct Selected {
  using key_type = Cell;
  using value_type = bool;
  using reference = bool;
  using category = boost::read_write_property_map_tag;
  bool operator()(const Cell &cell) const { return cell->subdomain_index() == MESH; }
  friend bool get(const Selected &selected, const Cell &cell) { return selected(cell); }
  friend void put(Selected, Cell cell, bool selected) {
    if (selected) cell->set_subdomain_index(MESH);
  }
};

static void remesh(Triangulation &t, int rounds, double length) {
  const auto options =
      CGAL::parameters::number_of_iterations(rounds).remesh_boundaries(false).cell_is_selected_map(Selected());
#if CGAL_VERSION_NR >= 1060000000
  (void)length;
  const auto sizes = CGAL::create_adaptive_remeshing_sizing_field(t, CGAL::parameters::cell_is_selected_map(Selected()));
  CGAL::tetrahedral_isotropic_remeshing(t, sizes, options);
#else
  CGAL::tetrahedral_isotropic_remeshing(t, length, options);
#endif
}

static void save(const Triangulation &t, const std::string &out) {
  std::ofstream points(out + ".points", std::ios::binary), tets(out + ".tets", std::ios::binary);
  std::unordered_map<const void *, uint32_t> row;
  for (Cell cell : t.finite_cell_handles()) {
    if (cell->subdomain_index() == CAVITY) continue;
    uint32_t corners[4];
    for (int i = 0; i < 4; i++) {
      const auto vertex = cell->vertex(i);
      const auto [at, is_new] = row.emplace(&*vertex, row.size());
      corners[i] = at->second;
      const double x[] = {vertex->point().x(), vertex->point().y(), vertex->point().z()};
      if (is_new) points.write(reinterpret_cast<const char *>(x), sizeof x);
    }
    tets.write(reinterpret_cast<const char *>(corners), sizeof corners);
  }
}

int main(int, char **words) {
  Triangulation t;
  std::ifstream file(words[1]);
  if (!CGAL::IO::read_MEDIT(file, t) || !t.tds().is_valid()) return std::fprintf(stderr, "no triangulation\n"), 1;
  const auto start = std::chrono::steady_clock::now();
  remesh(t, std::stoi(words[2]), std::stod(words[3]));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  save(t, words[4]);
  std::printf("\n{\"seconds\": %.6f, \"version\": \"%s\"}\n", took.count(), CGAL_VERSION_STR);
}
