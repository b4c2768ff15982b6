// Delaunay tetrahedralisation by CGAL: raw little-endian f64 triples in, JSON out.
// usage: delaunay_cgal FILE THREADS RUNS        (THREADS 0: CGAL's sequential triangulation)
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
template <class Concurrency>
using Triangulation = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_3<Kernel>,
                                                 CGAL::Delaunay_triangulation_cell_base_3<Kernel>, Concurrency>>;
using Points = std::vector<Kernel::Point_3>;

static Points read(const char *path) {
  std::ifstream file(path, std::ios::binary);
  Points points;
  double x[3];
  while (file.read(reinterpret_cast<char *>(x), sizeof x)) points.emplace_back(x[0], x[1], x[2]);
  return points;
}

static size_t sequential(const Points &points) {
  Triangulation<CGAL::Sequential_tag> t(points.begin(), points.end());
  return t.number_of_finite_cells();
}

static size_t parallel(const Points &points, const CGAL::Bbox_3 &box, int threads) {
  using T = Triangulation<CGAL::Parallel_tag>;
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  T::Lock_data_structure locks(box, 50); // the grid of CGAL's own example
  T t(points.begin(), points.end(), &locks);
  return t.number_of_finite_cells();
}

int main(int, char **words) {
  const Points points = read(words[1]);
  const int threads = std::stoi(words[2]), runs = std::stoi(words[3]);
  const CGAL::Bbox_3 box = CGAL::bbox_3(points.begin(), points.end());
  size_t tets = 0;
  std::string seconds;
  for (int run = 0; run < runs; run++) {
    const auto start = std::chrono::steady_clock::now();
    tets = threads == 0 ? sequential(points) : parallel(points, box, threads);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    seconds += (run ? ", " : "") + std::to_string(took.count());
  }
  std::printf("{\"seconds\": [%s], \"tets\": %zu, \"version\": \"%s\"}\n", seconds.c_str(), tets, CGAL_VERSION_STR);
}
