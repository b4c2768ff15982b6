// The same header in C++17: handles that free themselves, errors as exceptions.
#include <array>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "motet.h"

namespace {

template <auto free_one>
struct Free {
    template <class T>
    void operator()(T *handle) const { free_one(handle); }
};
using Mesh = std::unique_ptr<motet_mesh, Free<motet_mesh_free>>;
using Mover = std::unique_ptr<motet_mover, Free<motet_mover_free>>;
using Error = std::unique_ptr<motet_error, Free<motet_error_free>>;

// Makes a call with a place for its error, which is thrown.
template <class Call>
void ok(Call call)
{
    motet_error *raw = nullptr;
    const motet_status status = call(&raw);
    const Error error(raw);
    if (status != MOTET_OK) throw std::runtime_error(motet_error_message(error.get()));
}

Mesh two_tets()
{
    const std::vector<std::array<double, 3>> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    const std::vector<std::array<std::int32_t, 4>> tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    motet_mesh *mesh = nullptr;
    ok([&](auto error) { return motet_mesh_new(points[0].data(), std::int64_t(points.size()), 3, &mesh, error); });
    Mesh owned(mesh);
    ok([&](auto error) { return motet_mesh_add_cells(mesh, MOTET_TETRA, tets[0].data(), std::int64_t(tets.size()), error); });
    return owned;
}

} // namespace

int main()
{
    const Mesh mesh = two_tets();
    motet_mover *raw = nullptr;
    ok([&](auto error) { return motet_mover_new(mesh.get(), nullptr, &raw, error); });
    const Mover mover(raw);
    std::vector<double> displacement(3 * motet_mover_n_boundary(raw), 0.5), points(3 * motet_mover_n_points(raw));
    ok([&](auto error) {
        return motet_mover_step(raw, displacement.data(), motet_mover_n_boundary(raw), 3, points.data(), motet_mover_n_points(raw), 3, error);
    });
    if (points[3] != 1.5) return 1;
    try {
        ok([&](auto error) { return motet_mesh_read("/nowhere.vtu", &*std::make_unique<motet_mesh *>(), error); });
        return 1;
    } catch (const std::runtime_error &error) {
        std::cout << "as it should: " << error.what() << '\n';
    }
    return 0;
}
