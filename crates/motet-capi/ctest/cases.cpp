// The small cases of testdata, by motet.hpp: prints a name and a number a line, as cases.c does.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "motet.hpp"

namespace {

using words = std::vector<std::string>;

void report(const char *name, double value) { std::printf("%s %.17g\n", name, value); }

double number(const std::string &word) { return std::atof(word.c_str()); }

motet::point shift_of(const words &words) { return {number(words[2]), number(words[3]), number(words[4])}; }

std::vector<double> x_of(const std::vector<motet::point> &points)
{
    std::vector<double> x;
    for (const motet::point &point : points) x.push_back(point[0]);
    return x;
}

double sum_of(const std::vector<double> &values)
{
    double sum = 0;
    for (const double value : values) sum += value;
    return sum;
}

void report_mesh(motet::mesh_ref mesh)
{
    motet::point sum{};
    double worst = 1;
    for (const motet::point &point : mesh.points())
        for (std::size_t k = 0; k < 3; k++) sum[k] += point[k];
    for (const double eas : mesh.eas())
        if (eas < worst) worst = eas;
    report("points", double(mesh.n_points()));
    report("tets", double(mesh.n_of_kind(motet::cell_kind::tetra)));
    report("sum_x", sum[0]), report("sum_y", sum[1]), report("sum_z", sum[2]);
    report("worst_eas", worst);
}

void repair(const words &words)
{
    motet::mesh mesh = motet::mesh::read(words[0]);
    motet::mover_options options;
    options.smooth = std::int32_t(number(words[5]));
    motet::mover mover(mesh, options);
    const std::vector<std::int32_t> patch = mesh.patch_vertices(words[1]), boundary = mover.boundary();
    std::vector<motet::point> displacement(boundary.size()), points(mesh.n_points());
    for (std::size_t i = 0; i < boundary.size(); i++)
        if (std::binary_search(patch.begin(), patch.end(), boundary[i])) displacement[i] = shift_of(words);
    const motet::certificate certificate = mover.advance(displacement, points);
    report("complete", certificate.complete);
    report("bad_after_motion", double(certificate.bad));
    report("worst_after_motion", certificate.worst_eas);
    mesh.set_points(points);
    const motet::outcome repaired = motet::remesh(mesh);
    report("repaired", repaired.complete());
    report_mesh(repaired.mesh());
    report("sum_carried", sum_of(repaired.transfer(motet::on::points, motet::transfer_rule::mean, x_of(points))));
}

void implant(const words &words)
{
    const motet::mesh host = motet::mesh::read(words[0]), device = motet::mesh::read(words[1]);
    const motet::outcome outcome = motet::implant(host, {{device, words[2]}});
    report("complete", outcome.complete());
    report("region", outcome.mesh().region(words[2]).value_or(-1));
    report_mesh(outcome.mesh());
}

void contact(const words &words)
{
    std::vector<motet::point> points;
    std::vector<motet::body> bodies;
    for (const std::string &path : {words[0], words[1]}) {
        const motet::mesh mesh = motet::mesh::read(path);
        motet::body &body = bodies.emplace_back();
        body.triangles = mesh.triangles();
        for (auto &triangle : body.triangles)
            for (std::int32_t &vertex : triangle) vertex += std::int32_t(points.size());
        const std::vector<motet::point> more = mesh.points();
        points.insert(points.end(), more.begin(), more.end());
    }
    const motet::gaps gaps = motet::contact(points, bodies).measure();
    double sum = 0;
    for (const double gap : gaps.at_points)
        if (std::isfinite(gap)) sum += gap;
    report("least", gaps.least);
    report("sum_of_gaps", sum);
}

// A patch moves away in `n_steps` steps and returns in as many; the state is saved and loaded half way.
void loop(const words &words)
{
    const motet::mesh mesh = motet::mesh::read(words[0]);
    const int n_steps = int(number(words[5]));
    const std::string state = words[0] + ".state.vtu";
    motet::moving_options options;
    options.smooth = 2;
    motet::moving moving(mesh, options);
    const std::vector<motet::point> points = mesh.points(), places = moving.driven_places();
    const std::vector<std::int32_t> patch = mesh.patch_vertices(words[1]);
    std::vector<motet::point> shifts(places.size()), displacement(places.size());
    for (std::size_t i = 0, k = 0; i < places.size(); i++) // driven vertices and those of the patch are in ascending order
        if (k < patch.size() && places[i] == points[std::size_t(patch[k])]) shifts[i] = shift_of(words), k++;
    std::vector<double> x = x_of(points);
    std::int64_t n_changes = 0;
    for (int k = 1; k <= 2 * n_steps; k++) {
        const double part = double(k <= n_steps ? k : 2 * n_steps - k) / double(n_steps);
        for (std::size_t i = 0; i < places.size(); i++)
            for (std::size_t d = 0; d < 3; d++) displacement[i][d] = part * shifts[i][d];
        const motet::moving_step step = moving.advance(k, displacement);
        if (!step.complete || step.bad || step.inverted) std::exit(4);
        n_changes += step.changes;
        if (const std::optional<motet::outcome> changes = moving.since(k - 1)) // an array of the caller is transferred
            x = changes->transfer(motet::on::points, motet::transfer_rule::mean, x);
        if (k == n_steps) {
            moving.save(state);
            moving = motet::moving::load(state, options);
        }
    }
    report("changes", double(n_changes));
    report("time", moving.time());
    report("sum_velocity", sum_of(x_of(moving.velocity())));
    report("sum_carried", sum_of(x));
    report_mesh(moving.mesh());
}

} // namespace

int main(int n, char **all)
try {
    const std::string name = n > 1 ? all[1] : "";
    const words words(all + std::min(n, 2), all + n);
    if (words.size() == 6 && name == "repair") repair(words);
    else if (words.size() == 3 && name == "implant") implant(words);
    else if (words.size() == 2 && name == "contact") contact(words);
    else if (words.size() == 6 && name == "loop") loop(words);
    else return 2;
    return 0;
} catch (const motet::error &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
