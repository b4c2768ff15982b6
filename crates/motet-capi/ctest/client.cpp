// Tests motet.hpp in C++17 and C++20. Prints one line, or the first check that fails.
#include <cmath>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <thread>

#include "motet.hpp"

#if __cplusplus >= 202002L
#include <span>
#endif

#define CHECK(so)                                                                         \
    do {                                                                                  \
        if (!(so)) {                                                                      \
            std::cerr << __FILE__ << ":" << __LINE__ << ": check failed: " #so << '\n';   \
            std::exit(1);                                                                 \
        }                                                                                 \
    } while (false)

namespace {

// Makes a call that must fail with this code and these words.
template <class Call>
void refused(motet::status code, const std::string &words, Call call)
{
    try {
        call();
    } catch (const motet::error &error) {
        if (error.code() == code && std::string(error.what()).find(words) != std::string::npos) return;
        std::cerr << "refused otherwise: " << static_cast<int>(error.code()) << ' ' << error.what() << '\n';
        std::exit(1);
    }
    std::cerr << "not refused: " << words << '\n';
    std::exit(1);
}

constexpr int n = 6;

// The unit cube: each cell of a grid cut into six tets around its diagonal; its floor is a patch.
motet::mesh cube()
{
    const auto corner = [](int i, int j, int k) { return std::int32_t((k * (n + 1) + j) * (n + 1) + i); };
    constexpr std::array<std::array<int, 3>, 6> paths{{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}}};
    std::vector<motet::point> points;
    std::vector<std::array<std::int32_t, 4>> tets;
    std::vector<std::array<std::int32_t, 3>> floor;
    for (int k = 0; k <= n; k++)
        for (int j = 0; j <= n; j++)
            for (int i = 0; i <= n; i++) points.push_back({i / double(n), j / double(n), k / double(n)});
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) {
                for (std::size_t p = 0; p < 6; p++) {
                    const auto &a = paths[p], &b = paths[(p + 1) % 6];
                    tets.push_back({corner(i, j, k), corner(i + a[0], j + a[1], k + a[2]), corner(i + b[0], j + b[1], k + b[2]),
                                    corner(i + 1, j + 1, k + 1)});
                }
                if (k > 0) continue;
                floor.push_back({corner(i, j, 0), corner(i + 1, j + 1, 0), corner(i + 1, j, 0)});
                floor.push_back({corner(i, j, 0), corner(i, j + 1, 0), corner(i + 1, j + 1, 0)});
            }
    motet::mesh mesh(points);
    mesh.add_cells(motet::cell_kind::tetra, tets);
    mesh.add_cells(motet::cell_kind::triangle, floor);
    std::vector<std::int32_t> labels(tets.size(), 1);
    labels.resize(tets.size() + floor.size(), 7);
    mesh.set_labels(labels);
    mesh.name_region(1, "block");
    mesh.name_patch(7, "floor");
    return mesh;
}

motet::mesh octahedron(motet::point middle, double radius)
{
    std::vector<motet::point> points(6, middle);
    for (std::size_t i = 0; i < 6; i++) points[i][i / 2] += i % 2 ? -radius : radius;
    motet::mesh mesh(points);
    mesh.add_cells<3>(motet::cell_kind::triangle,
                      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
    return mesh;
}

// Options of C++ without changes are those of C without changes, member by member.
template <class C, class Options>
void same_defaults(void (*init)(C *, std::size_t))
{
    C c;
    init(&c, sizeof c);
    motet::detail::lists kept;
    const C cpp = motet::detail::given(Options(), kept);
    CHECK(std::memcmp(&c, &cpp, sizeof c) == 0);
}

void defaults()
{
    same_defaults<motet_mover_options, motet::mover_options>(motet_mover_options_init);
    same_defaults<motet_remesh_options, motet::remesh_options>(motet_remesh_options_init);
    same_defaults<motet_implant_options, motet::implant_options>(motet_implant_options_init);
    same_defaults<motet_fill_options, motet::fill_options>(motet_fill_options_init);
    same_defaults<motet_refinement_options, motet::refinement_options>(motet_refinement_options_init);
    same_defaults<motet_contact_options, motet::contact_options>(motet_contact_options_init);
    same_defaults<motet_moving_options, motet::moving_options>(motet_moving_options_init);
}

void meshes()
{
    motet::mesh mesh = cube();
    CHECK(motet::version() == MOTET_VERSION_MAJOR * 10000 + MOTET_VERSION_MINOR * 100 + MOTET_VERSION_PATCH);
    CHECK(mesh.n_points() == (n + 1) * (n + 1) * (n + 1) && mesh.n_cells() == 6 * n * n * n + 2 * n * n);
    CHECK(mesh.tets().size() == 6 * n * n * n && mesh.triangles().size() == 2 * n * n && mesh.region("block") == 1);
    CHECK(mesh.patch("floor") == 7 && !mesh.patch("roof") && mesh.patch_vertices("floor").size() == (n + 1) * (n + 1));
    const motet::cell_lists cells = mesh.cells();
    CHECK(cells.offsets.back() == std::int64_t(cells.vertices.size()) && cells.kinds.front() == MOTET_TETRA);
    CHECK(mesh.labels().back() == 7 && std::isnan(mesh.eas().back()) && mesh.eas().front() > 0.3);
    const std::vector<double> x(2 * mesh.n_points(), 5.0);
    mesh.set_array(motet::on::points, "x", x, 2);
    const motet::mesh_array array = mesh.array(motet::on::points, "x");
    CHECK(array.components == 2 && array.values == x && mesh.array(motet::on::cells, "x").components == 0);
    CHECK(mesh.summary().find("\"floor\"") != std::string::npos);

    // Points in rows of four, and of any type of three doubles.
    std::vector<double> apart(4 * mesh.n_points(), -7.0);
    mesh.points(motet::rows<double>(apart.data(), std::size_t(mesh.n_points()), 4));
    CHECK(apart[4] == 1 / double(n) && apart[3] == -7.0);
    struct vector3 {
        double x, y, z;
    };
    std::vector<vector3> own(mesh.n_points());
    mesh.points(own);
    own[0].x = -0.01;
    mesh.set_points(own);
    CHECK(mesh.points()[0][0] == -0.01);

    // A copy is a mesh of its own; a mesh that was moved from is empty, and can be assigned to.
    motet::mesh copy = mesh.copy(), moved = std::move(copy);
    mesh.set_points(std::vector<double>(3 * mesh.n_points()));
    CHECK(moved.points()[0][0] == -0.01 && copy.get() == nullptr && copy.n_points() == 0);
    refused(motet::status::options, "mesh is NULL", [&] { copy.set_labels({}); });
    copy = std::move(moved);
    CHECK(copy.points()[0][0] == -0.01);

    // Errors carry their parts.
    try {
        motet::mesh::read("/nowhere.vtu");
        CHECK(false);
    } catch (const motet::error &error) {
        CHECK(error.code() == motet::status::io && error.file() == "/nowhere.vtu" && !error.cause().empty() && !error.place());
    }
    refused(motet::status::options, "not rows of three", [&] { mesh.set_points(std::vector<double>(7)); });
    refused(motet::status::options, "not cells of 4", [&] { mesh.add_cells(motet::cell_kind::tetra, std::vector<std::int32_t>(6), 4); });
    refused(motet::status::options, "not rows of 2", [&] { mesh.set_array(motet::on::points, "x", std::vector<double>(3), 2); });
    refused(motet::status::options, "no patch", [&] { mesh.patch_vertices("roof"); });

    // What a file cannot hold is said.
    copy.write("client_cpp.vtu");
    std::vector<std::string> notes = {"old"};
    CHECK(motet::mesh::read_noted("client_cpp.vtu", notes).n_points() == copy.n_points() && notes.empty());
    CHECK(copy.write_noted("client_cpp.vtu").empty() && !copy.write_noted("client_cpp.off").empty());
    CHECK(motet::mesh::read("client_cpp.vtu").patch("floor") == 7);
    std::remove("client_cpp.vtu"), std::remove("client_cpp.off");
}

void motion()
{
    const motet::mesh mesh = cube();
    motet::mover_options options;
    options.slide = {"floor"};
    motet::mover mover(mesh, options);
    CHECK(motet::mover(mesh).n_boundary() == std::int64_t(motet::mover(mesh).boundary().size()));
    std::vector<motet::point> displacement(mover.n_boundary(), {0.5, 0, 0}), points(mover.n_points()), again(mover.n_points());
    mover.step(displacement, points);
    const motet::certificate reached = mover.advance(displacement, again);
    CHECK(reached.complete && reached.inverted == 0 && points == again && points[1][0] == 0.5 + 1 / double(n));
    CHECK(!mover.weights(0) && mover.weights((n + 1) * (n + 1) + n + 2));
    refused(motet::status::options, "share memory", [&] { mover.step(motet::view<const motet::point>(points.data(), displacement.size()), points); });
    refused(motet::status::options, "no patch `door`", [&] {
        options.slide = {"floor", "door"};
        motet::mover(mesh, options);
    });
#if __cplusplus >= 202002L
    const std::span<const motet::point> part = displacement;
    mover.step(part, std::span(points));
    const motet::view<const motet::point> lent = displacement;
    CHECK(std::span<const motet::point>(lent).size() == displacement.size());
#endif
    const std::vector<motet::point> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    const motet::point_mover by_nodes(corners, mesh.points());
    by_nodes.step(std::vector<motet::point>(5, {0, 0, 2}), points);
    CHECK(std::abs(points[0][2] - 2) < 1e-12);
}

void changes()
{
    const motet::mesh mesh = cube(), device = octahedron({0.5, 0.5, 0.5}, 0.2);
    motet::remesh_options options;
    options.edge_length = 0.12;
    options.hold = {"floor"};
    const motet::outcome finer = motet::remesh(mesh, options);
    std::vector<double> x;
    for (const motet::point &point : mesh.points()) x.push_back(point[0]), x.push_back(2 * point[1]);
    const std::vector<double> carried = finer.transfer(motet::on::points, motet::transfer_rule::mean, x, 2);
    const std::vector<motet::point> points = finer.mesh().points();
    CHECK(points.size() > x.size() / 2 && carried.size() == 2 * points.size() && finer.to_old(motet::on::points)[0] == 0);
    for (std::size_t i = 0; i < points.size(); i++) CHECK(std::abs(carried[2 * i + 1] - 2 * points[i][1]) < 1e-12);
    CHECK(finer.complete() == !finer.not_reached() && finer.report().front() == '{');
    options.min_eas = 2;
    refused(motet::status::options, "EAS", [&] { motet::remesh(mesh, options); });
#if __cplusplus >= 202002L
    refused(motet::status::options, "EAS", [&] { motet::remesh(mesh, {.min_eas = 2, .hold = {"floor"}}); });
#endif

    const motet::outcome implanted = motet::implant(mesh, {{device, "seed"}});
    CHECK(implanted.complete() && implanted.mesh().region("seed"));
    motet::fill_options sizes;
    sizes.edge_length = 0.04;
    const motet::outcome filled = motet::fill({{device, "seed"}}, sizes);
    CHECK(filled.mesh().n_of_kind(motet::cell_kind::tetra) > 8);
    refused(motet::status::options, "history", [&] { filled.to_old(motet::on::points); });

    motet::refinement refinement(mesh);
    CHECK(refinement.near(device, 0.1, 0.5).complete());
    std::int64_t before = 0;
    while (before != refinement.mesh().n_cells()) {
        before = refinement.mesh().n_cells();
        std::vector<std::int32_t> marks = refinement.generations();
        for (std::int32_t &mark : marks) mark = mark > 0;
        refinement.coarsen(marks);
    }
    CHECK(before == mesh.n_cells());
    std::vector<std::int32_t> one(before);
    one[0] = 1;
    CHECK(refinement.divide(one).mesh().n_cells() == refinement.mesh().n_cells() && refinement.mesh().n_cells() > before);
}

void contact()
{
    std::vector<motet::point> points = octahedron({0, 0, 0}, 1).points(), other = octahedron({2.5, 0, 0}, 1).points();
    std::vector<motet::body> bodies(2);
    bodies[0].triangles = bodies[1].triangles = octahedron({0, 0, 0}, 1).triangles();
    for (auto &triangle : bodies[1].triangles)
        for (std::int32_t &vertex : triangle) vertex += 6;
    points.insert(points.end(), other.begin(), other.end());
    motet::contact contact(points, bodies);
    CHECK(std::abs(contact.measure().least - 0.5) < 1e-15 && contact.measure().at_points.size() == 12);
    CHECK(std::abs(contact.nearest(1, 0).places[0][0] - 1.5) < 1e-15);
    std::vector<motet::point> velocity(12);
    for (std::size_t i = 6; i < 12; i++) velocity[i][0] = -1, points[i][0] -= 0.25;
    CHECK(std::abs(contact.ahead(velocity) - 0.5) < 1e-6);
    contact.refit(points);
    CHECK(std::abs(contact.measure().least - 0.25) < 1e-15);
}

// The whole loop: the floor bulges, the mesh is repaired, an array of the caller is transferred; saved and loaded on
// the way.
void loop()
{
    const motet::mesh mesh = cube();
    motet::moving_options options;
    options.contents = {"density"};
    motet::mesh with_density = mesh.copy();
    with_density.set_array(motet::on::cells, "density", std::vector<double>(mesh.n_cells(), 2.0));
    motet::moving moving(with_density, options);
    const std::vector<motet::point> places = moving.driven_places();
    std::vector<motet::point> displacement(places.size());
    std::vector<double> x;
    for (const motet::point &point : mesh.points()) x.push_back(3 * point[0] - 1);
    std::int64_t n_changes = 0;
    for (int k = 1; k <= 4; k++) {
        for (std::size_t i = 0; i < places.size(); i++)
            displacement[i][2] = places[i][2] > 0 ? 0 : 2.56 * k * places[i][0] * (1 - places[i][0]) * places[i][1] * (1 - places[i][1]);
        const motet::moving_step step = moving.advance(0.25 * k, displacement);
        CHECK(step.complete && step.inverted == 0 && step.step == k && moving.step() == k);
        n_changes += step.changes;
        if (const std::optional<motet::outcome> changes = moving.since(k - 1))
            x = changes->transfer(motet::on::points, motet::transfer_rule::mean, x);
        CHECK(x.size() == std::size_t(moving.mesh().n_points()));
        if (k == 2) {
            moving.save("client_cpp_state.vtu");
            moving = motet::moving::load("client_cpp_state.vtu", options);
            std::remove("client_cpp_state.vtu");
        }
    }
    const std::vector<motet::point> points = moving.mesh().points(), shifts = moving.displacement();
    CHECK(n_changes > 0 && moving.time() == 1 && moving.velocity().size() == points.size() && moving.remembers(2));
    for (std::size_t i = 0; i < x.size(); i++) CHECK(std::abs(x[i] - (3 * (points[i][0] - shifts[i][0]) - 1)) < 1e-12);
    moving.set_array(motet::on::points, "x", x);
    moving.repair();
    CHECK(moving.refine_near(octahedron({0.5, 0.5, 0.9}, 0.05), 0.06, 0.5, true) > 0);
    CHECK(moving.mesh().array(motet::on::points, "x").values.size() > x.size());
    refused(motet::status::options, "smallest", [&] { moving.refine_gaps(0, true); });
    refused(motet::status::options, "not after the current time", [&] { moving.advance(1, displacement); });
}

struct enough : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// What the listener throws comes out of the call, on this thread; objects are as before.
void watched()
{
    const motet::mesh mesh = cube();
    const auto here = std::this_thread::get_id();
    int n_told = 0;
    bool has_thrown = false;
    motet::watch watch(
        [&](const motet::progress &progress) {
            CHECK(std::this_thread::get_id() == here);
            n_told++;
            if (progress.stage.empty() || has_thrown) return false;
            has_thrown = true;
            throw enough(progress.stage);
        },
        2e-4);
    motet::remesh_options options;
    options.edge_length = 0.09;
    const auto plain = motet::remesh(mesh, options).mesh().points();
    options.watched_by = &watch;
    try {
        motet::remesh(mesh, options);
        CHECK(false);
    } catch (const enough &stage) {
        CHECK(n_told > 0 && watch.now().stage.size() > 0 && std::strlen(stage.what()) > 0);
    }
    CHECK(motet::remesh(mesh, options).mesh().points() == plain);

    // A listener that returns true; a request of another thread; a request before the call.
    motet::watch stopping([](const motet::progress &) { return true; }, 1e-3), silent;
    options.edge_length = 0.02;
    options.watched_by = &stopping;
    refused(motet::status::stopped, "stopped on request", [&] { motet::remesh(mesh, options); });
    options.watched_by = &silent;
    std::thread other([&] {
        while (silent.now().stage.empty()) std::this_thread::yield();
        silent.stop();
    });
    refused(motet::status::stopped, "stopped on request", [&] { motet::remesh(mesh, options); });
    other.join();

    // The watch of an object can be moved; the object goes on without it.
    motet::watch calm([](const motet::progress &) { return false; });
    motet::moving_options of_moving;
    of_moving.watched_by = &calm;
    calm.stop();
    refused(motet::status::stopped, "setting up", [&] { motet::moving(mesh, of_moving); });
    motet::moving moving(mesh, of_moving);
    const std::vector<motet::point> still(moving.n_driven());
    {
        const motet::watch passing = std::move(calm);
        passing.stop();
        refused(motet::status::stopped, "stopped on request", [&] { moving.advance(1, still); });
        CHECK(moving.step() == 0 && moving.advance(1, still).complete);
    }
    CHECK(moving.advance(2, still).complete);
}

} // namespace

int main()
{
    defaults();
    meshes();
    motion();
    changes();
    contact();
    loop();
    watched();
    std::cout << "all checks of motet.hpp passed\n";
    return 0;
}
