// Distances of points from a triangle surface by CGAL's AABB tree: JSON out.
// usage: contact_cgal FOLDER THREADS RUNS DISTANCES
// At a step the tree is built again, for CGAL refits none; the place on the triangle that was nearest last is the hint
// of each search, so that CGAL's tree of hints is not needed.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>>>;
const int STEPS = 8; // in the folder

template <class T> static std::vector<T> read(const std::string &path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<T> all(size_t(file.tellg()) / sizeof(T));
  file.seekg(0).read(reinterpret_cast<char *>(all.data()), all.size() * sizeof(T));
  return all;
}

static std::vector<Point> points(const std::string &path) {
  const auto x = read<double>(path);
  std::vector<Point> all;
  for (size_t i = 0; i < x.size(); i += 3) all.emplace_back(x[i], x[i + 1], x[i + 2]);
  return all;
}

template <class Work> static double seconds(const Work &work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Work> static void shared_out(size_t n, int threads, const Work &work) {
  std::vector<std::thread> others;
  for (int k = 1; k < threads; k++) others.emplace_back(work, n * k / threads, n * (k + 1) / threads);
  work(size_t(0), n / threads);
  for (auto &other : others) other.join();
}

static double median(std::vector<double> all) {
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}

static void write(const std::string &path, const std::vector<double> &all) {
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char *>(all.data()), all.size() * sizeof(double));
}

int main(int, char **words) {
  const std::string folder = words[1], distances = words[4];
  const int threads = std::stoi(words[2]), runs = std::stoi(words[3]);
  const auto corners = read<uint32_t>(folder + "/tube.u32");
  Triangles triangles(corners.size() / 3);
  const auto take = [&](const std::vector<Point> &at) {
    for (size_t i = 0; i < triangles.size(); i++)
      triangles[i] = {at[corners[3 * i]], at[corners[3 * i + 1]], at[corners[3 * i + 2]]};
  };
  const auto tube = points(folder + "/tube.f64"), rest = points(folder + "/lattice.f64");
  std::vector<double> found(rest.size()), building, asking, whole;
  std::vector<Triangles::iterator> last(rest.size());
  std::unique_ptr<Tree> tree;
  for (int run = 0; run < runs; run++) {
    building.push_back(seconds([&] {
      take(tube);
      tree = std::make_unique<Tree>(triangles.begin(), triangles.end());
      tree->build();
      tree->accelerate_distance_queries();
    }));
    asking.push_back(seconds([&] {
      shared_out(rest.size(), threads, [&](size_t from, size_t to) {
        for (size_t i = from; i < to; i++) {
          const auto [place, triangle] = tree->closest_point_and_primitive(rest[i]);
          found[i] = std::sqrt(CGAL::squared_distance(rest[i], place));
          last[i] = triangle;
        }
      });
    }));
    whole.push_back(building.back() + asking.back());
  }
  write(distances + ".f64", found);
  std::vector<double> moving, warm, step;
  for (int k = 0; k < STEPS; k++) {
    const auto tube = points(folder + "/tube_" + std::to_string(k) + ".f64");
    const auto queries = points(folder + "/lattice_" + std::to_string(k) + ".f64");
    moving.push_back(seconds([&] {
      take(tube);
      tree = std::make_unique<Tree>(triangles.begin(), triangles.end());
      tree->do_not_accelerate_distance_queries();
      tree->build();
    }));
    warm.push_back(seconds([&] {
      shared_out(queries.size(), threads, [&](size_t from, size_t to) {
        const auto project = Kernel().construct_projected_point_3_object();
        for (size_t i = from; i < to; i++) {
          const auto [place, triangle] =
              tree->closest_point_and_primitive(queries[i], {project(*last[i], queries[i]), last[i]});
          found[i] = std::sqrt(CGAL::squared_distance(queries[i], place));
          last[i] = triangle;
        }
      });
    }));
    step.push_back(moving.back() + warm.back());
  }
  write(distances + "_step.f64", found);
  std::string list;
  for (double s : whole) list += (list.empty() ? "" : ", ") + std::to_string(s);
  std::printf("{\"seconds\": [%s], \"build_seconds\": %.6f, \"cold_seconds\": %.6f, \"refit_seconds\": %.6f, "
              "\"warm_seconds\": %.6f, \"step_seconds\": %.6f, \"version\": \"%s\"}\n",
              list.c_str(), median(building), median(asking), median(moving), median(warm), median(step), CGAL_VERSION_STR);
}
