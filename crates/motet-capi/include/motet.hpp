// motet for C++17: tetrahedral meshes that stay good while the world in them moves.
//
// This header is motet.h with classes, and needs nothing but it and the C library; motet.h is the reference for
// what each call does.
//
// Arrays.    Coordinates and vectors are rows of three doubles: `rows` refers to memory of the caller, such as
//            std::vector<std::array<double, 3>>, std::vector<double>, or rows of a class of three doubles; other
//            arrays are referred to by `view`, which any contiguous container converts to, std::span too. Input
//            arrays are read during the call only. Arrays that a call returns belong to the caller. Ids are
//            std::int32_t and start at 0, counts are std::int64_t.
// Units.     Lengths are in the unit of the mesh, angles in degrees.
// Handles.   Objects own what they hold, can be moved, and are copied only by a function that says so. One that
//            was moved from can be assigned to and destroyed; its other calls throw. What an object lends (a
//            mesh_ref) is valid until the object is changed or destroyed.
// Errors.    A call that fails throws motet::error; inputs and objects are as before.
// Threads.   There is no global state. Different objects may be used at the same time; const calls of one object
//            may run at the same time, others may not. `threads` in options: 0 for all cores, 1 for the thread of
//            the caller only. Results do not depend on it.
#ifndef MOTET_HPP
#define MOTET_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "motet.h"

namespace motet {

/// The version of the linked library: major * 10000 + minor * 100 + patch.
inline std::int32_t version() noexcept { return motet_version(); }

// ---- Errors -----------------------------------------------------------------------------------------------

/// Why a call failed.
enum class status : std::int32_t {
    internal = MOTET_ERROR_INTERNAL, ///< a bug in motet; objects that were to change cannot be used any longer
    options = MOTET_ERROR_OPTIONS,   ///< options without a meaning, an object that was moved from, a wrong count
    input = MOTET_ERROR_INPUT,       ///< data that cannot be read, or that do not meet what the call requires
    io = MOTET_ERROR_IO,             ///< the operating system refused access to a file
    stopped = MOTET_ERROR_STOPPED    ///< a watch stopped the call
};

/// The exception of all calls. what() is the whole error in one sentence or two.
class error : public std::runtime_error {
public:
    error(status code, const std::string &message, std::string cause, std::optional<std::string> file = {},
          std::optional<std::string> place = {}, std::optional<std::string> remedy = {})
        : std::runtime_error(message), code_(code),
          parts_(std::make_shared<parts>(parts{std::move(cause), std::move(file), std::move(place), std::move(remedy)}))
    {
    }

    status code() const noexcept { return code_; }
    /// What was expected and what was found.
    const std::string &cause() const noexcept { return parts_->cause; }
    /// The file that the error is in, if it is in one.
    const std::optional<std::string> &file() const noexcept { return parts_->file; }
    /// The place in the file or in the mesh, if there is one.
    const std::optional<std::string> &place() const noexcept { return parts_->place; }
    /// What can be done about the error, if that is known.
    const std::optional<std::string> &remedy() const noexcept { return parts_->remedy; }

private:
    struct parts {
        std::string cause;
        std::optional<std::string> file, place, remedy;
    };
    status code_;
    std::shared_ptr<const parts> parts_; // an exception must not throw when it is copied
};

namespace detail {

template <auto free_one>
struct freed_by {
    template <class T>
    void operator()(T *handle) const noexcept { free_one(handle); }
};

template <class T, auto free_one>
using owned = std::unique_ptr<T, freed_by<free_one>>;

using owned_text = owned<motet_text, motet_text_free>;

inline std::optional<std::string> optional_text(const char *text)
{
    if (text == nullptr) return std::nullopt;
    return std::string(text);
}

inline std::string text(const char *text) { return optional_text(text).value_or(std::string()); }

/// The lines of a text; none for NULL.
inline std::vector<std::string> lines(const char *text)
{
    std::vector<std::string> all;
    const std::string rest = detail::text(text);
    for (std::size_t at = 0; at < rest.size();) {
        const std::size_t end = std::min(rest.find('\n', at), rest.size());
        all.push_back(rest.substr(at, end - at));
        at = end + 1;
    }
    return all;
}

/// Makes a call with a place for its error, and throws the error.
template <class Call>
void call(Call &&make)
{
    motet_error *raw = nullptr;
    if (make(&raw) == MOTET_OK) return;
    const owned<motet_error, motet_error_free> error(raw);
    throw motet::error(static_cast<status>(motet_error_status(raw)), text(motet_error_message(raw)),
                       text(motet_error_what(raw)), optional_text(motet_error_file(raw)),
                       optional_text(motet_error_place(raw)), optional_text(motet_error_remedy(raw)));
}

[[noreturn]] inline void refuse(const std::string &cause) { throw error(status::options, cause, cause); }

/// Makes a call that returns an object.
template <class Owned, class Call>
Owned made(Call &&make)
{
    typename Owned::pointer raw = nullptr;
    call([&](motet_error **error) { return make(&raw, error); });
    return Owned(raw);
}

inline std::int64_t count(std::size_t n) { return static_cast<std::int64_t>(n); }

inline std::size_t size(std::int64_t n) { return static_cast<std::size_t>(n); }

template <class Container>
using element = std::remove_pointer_t<decltype(std::data(std::declval<Container &>()))>;

} // namespace detail

// ---- Arrays -----------------------------------------------------------------------------------------------

/// Refers to an array of somebody else: a pointer and a count.
template <class T>
class view {
public:
    constexpr view() noexcept = default;
    constexpr view(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
    /// Any contiguous container: std::vector, std::array, std::span.
    template <class Container, class Element = detail::element<Container>,
              std::enable_if_t<std::is_convertible_v<Element (*)[], T (*)[]> &&
                                   !std::is_same_v<std::decay_t<Container>, view>,
                               int> = 0>
    constexpr view(Container &&container) : data_(std::data(container)), size_(std::size(container))
    {
    }

    constexpr T *data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0; }
    constexpr T *begin() const noexcept { return data_; }
    constexpr T *end() const noexcept { return data_ + size_; }
    constexpr T &operator[](std::size_t i) const { return data_[i]; }

private:
    T *data_ = nullptr;
    std::size_t size_ = 0;
};

/// A point or a vector.
using point = std::array<double, 3>;

/// Refers to rows of three doubles of somebody else: `rows<const double>` to be read, `rows<double>` to be
/// written. `stride` is the number of doubles from one row to the next: 3 for contiguous rows, which are used in
/// place.
template <class T>
class rows {
public:
    constexpr rows(T *data, std::size_t size, std::size_t stride = 3) noexcept
        : data_(data), size_(size), stride_(stride)
    {
    }
    /// A contiguous container of doubles, three for each row, or of rows: any type of three doubles.
    template <class Container, class Element = detail::element<Container>,
              std::enable_if_t<(std::is_const_v<T> || !std::is_const_v<Element>)&&(
                                   std::is_same_v<std::remove_const_t<Element>, double> ||
                                   (sizeof(Element) == 3 * sizeof(double) && std::is_trivially_copyable_v<Element>)),
                               int> = 0>
    rows(Container &&container) : data_(reinterpret_cast<T *>(std::data(container)))
    {
        size_ = std::size(container);
        if constexpr (std::is_same_v<std::remove_const_t<Element>, double>) {
            if (size_ % 3 != 0) detail::refuse(std::to_string(size_) + " numbers are not rows of three");
            size_ /= 3;
        }
    }
    /// Rows to be written can be read.
    template <class U, std::enable_if_t<std::is_same_v<const U, T> && !std::is_same_v<U, T>, int> = 0>
    constexpr rows(const rows<U> &other) noexcept : rows(other.data(), other.size(), other.stride())
    {
    }

    constexpr T *data() const noexcept { return data_; }
    /// The number of rows.
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr std::size_t stride() const noexcept { return stride_; }

private:
    T *data_;
    std::size_t size_ = 0, stride_ = 3;
};

// ---- Long calls -------------------------------------------------------------------------------------------

/// How far a call is.
struct progress {
    std::string stage;     ///< what is being done; empty at first. A stage may occur more than once
    std::int64_t done = 0; ///< how much of it is done
    std::int64_t of = 0;   ///< how much there is to do as far as is known by now; 0 where that is unknown
};

namespace detail {

/// The function that is told the progress, and what it threw.
struct listening {
    std::function<bool(const progress &)> tell;
    std::exception_ptr thrown;

    static std::int32_t told(void *data, const char *stage, std::int64_t done, std::int64_t of) noexcept
    {
        listening &self = *static_cast<listening *>(data);
        try {
            return self.tell(progress{stage, done, of});
        } catch (...) {
            self.thrown = std::current_exception();
            return true;
        }
    }
};

using listener = std::shared_ptr<listening>;

/// Makes a call that may be watched; what the listener threw is thrown, whatever became of the call.
template <class Call>
void watched(const listener &by, Call &&make)
{
    const auto rethrow = [&] {
        if (by && by->thrown) std::rethrow_exception(std::exchange(by->thrown, nullptr));
    };
    try {
        call(make);
    } catch (const error &) {
        rethrow();
        throw;
    }
    rethrow();
}

/// Makes a call that may be watched and returns an object.
template <class Owned, class Call>
Owned made(const listener &by, Call &&make)
{
    Owned object;
    watched(by, [&](motet_error **error) {
        typename Owned::pointer raw = nullptr;
        const motet_status status = make(&raw, error);
        object.reset(raw);
        return status;
    });
    return object;
}

} // namespace detail

/// Tells the progress of long calls and stops them: of those that have it as `watched_by` in their options, and
/// of the calls of objects made with such options, but for mover::step, refinement::divide and
/// refinement::coarsen. It watches one call at a time and must not be destroyed during one.
class watch {
public:
    /// Is told the progress; returns true to stop the call. What it throws stops the call, too, and comes out of
    /// that call. It must not use the objects of the watched call.
    using listener = std::function<bool(const progress &)>;

    /// A watch that tells nobody: progress is asked for, and calls are stopped, by other threads.
    watch()
        : handle_(detail::made<owned>(
              [](motet_watch **place, motet_error **error) { return motet_watch_new(place, error); }))
    {
    }
    /// `tell` is called on the thread that makes the watched call, every `every` seconds while that runs (0:
    /// 0.05), whether or not there is progress; the work goes on meanwhile, on another thread.
    explicit watch(listener tell, double every = 0) : watch()
    {
        listener_ = std::make_shared<detail::listening>(detail::listening{std::move(tell), nullptr});
        detail::call([&](motet_error **error) {
            return motet_watch_on_progress(get(), detail::listening::told, listener_.get(), every, error);
        });
    }

    /// Stops the watched call soon, or the next one if none is running: it throws an error of status::stopped,
    /// and the request is used up. From any thread, or by a handler of signals.
    void stop() const noexcept { motet_watch_stop(get()); }
    /// The progress of the watched call, or of the last one; from any thread.
    progress now() const
    {
        progress now;
        std::array<char, 64> stage{};
        detail::call([&](motet_error **error) {
            return motet_watch_progress(get(), stage.data(), detail::count(stage.size()), &now.done, &now.of, error);
        });
        now.stage = stage.data();
        return now;
    }

    motet_watch *get() const noexcept { return handle_.get(); }

private:
    using owned = detail::owned<motet_watch, motet_watch_free>;
    friend detail::listener listener_of(const watch *watch);

    detail::listener listener_; // freed after the handle, which refers to it
    owned handle_;
};

inline detail::listener listener_of(const watch *watch) { return watch ? watch->listener_ : nullptr; }

// ---- Meshes -----------------------------------------------------------------------------------------------

/// Kinds of cells: VTK's numbers, with VTK's order of vertices. VTK's other kinds are accepted as well.
enum class cell_kind : std::int32_t {
    vertex = MOTET_VERTEX,
    line = MOTET_LINE,
    triangle = MOTET_TRIANGLE,
    quad = MOTET_QUAD,
    tetra = MOTET_TETRA,
    hexahedron = MOTET_HEXAHEDRON,
    wedge = MOTET_WEDGE,
    pyramid = MOTET_PYRAMID,
    tetra10 = MOTET_TETRA10
};

/// What the rows of an array belong to.
enum class on : std::int32_t { points = MOTET_ON_POINTS, cells = MOTET_ON_CELLS };

/// All cells of a mesh in their order.
struct cell_lists {
    std::vector<std::int32_t> kinds;    ///< the kind of each, a number of VTK
    std::vector<std::int64_t> offsets;  ///< where the vertices of each begin, and the end of the last
    std::vector<std::int32_t> vertices; ///< the vertices of all cells
};

/// An array of a mesh.
struct mesh_array {
    std::int32_t components = 0; ///< the number of values of each point or cell
    std::vector<double> values;  ///< row after row
};

class mesh;

/// Refers to a mesh of somebody else, which can be read.
class mesh_ref {
public:
    explicit mesh_ref(const motet_mesh *mesh) noexcept : mesh_(mesh) {}

    const motet_mesh *get() const noexcept { return mesh_; }

    /// A mesh of its own with the same arrays and names.
    mesh copy() const;
    /// Writes a file; its suffix states the format.
    void write(const std::string &path) const
    {
        detail::call([&](motet_error **error) { return motet_mesh_write(get(), path.c_str(), error); });
    }
    /// Writes a file and returns what the format cannot hold, a sentence each.
    std::vector<std::string> write_noted(const std::string &path) const
    {
        const auto lost = detail::made<detail::owned_text>([&](motet_text **place, motet_error **error) {
            return motet_mesh_write_noted(get(), path.c_str(), place, error);
        });
        return detail::lines(motet_text_get(lost.get()));
    }

    std::int64_t n_points() const noexcept { return motet_mesh_n_points(get()); }
    /// The number of cells of all kinds.
    std::int64_t n_cells() const noexcept { return motet_mesh_n_cells(get()); }
    std::int64_t n_of_kind(cell_kind kind) const noexcept
    {
        return motet_mesh_n_of_kind(get(), static_cast<std::int32_t>(kind));
    }
    /// The sum of the numbers of vertices of all cells.
    std::int64_t n_vertices_of_cells() const noexcept { return motet_mesh_n_vertices_of_cells(get()); }
    /// The coordinates of all points.
    std::vector<point> points() const
    {
        std::vector<point> all(detail::size(n_points()));
        points(all);
        return all;
    }
    /// Copies the coordinates of all points to `out`, which has a row for each.
    void points(rows<double> out) const
    {
        detail::call([&](motet_error **error) {
            return motet_mesh_points(get(), out.data(), detail::count(out.size()), detail::count(out.stride()), error);
        });
    }
    /// The vertices of all cells of one kind, `of_each` for each, cell after cell.
    std::vector<std::int32_t> of_kind(cell_kind kind, std::int32_t of_each) const
    {
        std::vector<std::int32_t> all(detail::size(n_of_kind(kind) * of_each));
        detail::call([&](motet_error **error) {
            return motet_mesh_of_kind(get(), static_cast<std::int32_t>(kind), all.data(), detail::count(all.size()),
                                      error);
        });
        return all;
    }
    /// The vertices of all tets.
    std::vector<std::array<std::int32_t, 4>> tets() const { return of_kind<4>(cell_kind::tetra); }
    /// The vertices of all triangles.
    std::vector<std::array<std::int32_t, 3>> triangles() const { return of_kind<3>(cell_kind::triangle); }
    cell_lists cells() const
    {
        cell_lists all;
        all.kinds.resize(detail::size(n_cells()));
        all.offsets.resize(all.kinds.size() + 1);
        all.vertices.resize(detail::size(n_vertices_of_cells()));
        detail::call([&](motet_error **error) {
            return motet_mesh_cells(get(), all.kinds.data(), detail::count(all.kinds.size()), all.offsets.data(),
                                    all.vertices.data(), detail::count(all.vertices.size()), error);
        });
        return all;
    }
    /// The label of each cell: regions of volume cells, patches of surface cells; 0 for none.
    std::vector<std::int32_t> labels() const
    {
        std::vector<std::int32_t> all(detail::size(n_cells()));
        detail::call([&](motet_error **error) { return motet_mesh_labels(get(), all.data(), n_cells(), error); });
        return all;
    }
    /// The label of a region by its name, if there is such a region.
    std::optional<std::int32_t> region(const std::string &name) const
    {
        return label(motet_mesh_region(get(), name.c_str()));
    }
    /// The label of a patch by its name, if there is such a patch.
    std::optional<std::int32_t> patch(const std::string &name) const
    {
        return label(motet_mesh_patch(get(), name.c_str()));
    }
    /// The vertices of a patch in ascending order, by its name or its label as text.
    std::vector<std::int32_t> patch_vertices(const std::string &name) const
    {
        const std::int64_t n = motet_mesh_n_patch_vertices(get(), name.c_str());
        std::vector<std::int32_t> all(detail::size(std::max(n, std::int64_t{0})));
        detail::call([&](motet_error **error) {
            return motet_mesh_patch_vertices(get(), name.c_str(), all.data(), detail::count(all.size()), error);
        });
        return all;
    }
    /// An array of numbers by its name; it has no components where there is none.
    mesh_array array(on where, const std::string &name) const
    {
        mesh_array found;
        found.components = motet_mesh_array_components(get(), static_cast<std::int32_t>(where), name.c_str());
        if (found.components == 0) return found;
        const std::int64_t n = where == on::points ? n_points() : n_cells();
        found.values.resize(detail::size(n * found.components));
        detail::call([&](motet_error **error) {
            return motet_mesh_array(get(), static_cast<std::int32_t>(where), name.c_str(), found.values.data(), n,
                                    error);
        });
        return found;
    }
    /// The equi-angle quality (EAS) of each cell: 1 regular, 0 flat, negative inverted, bad below 0.2; NaN for
    /// cells that are not tets.
    std::vector<double> eas() const
    {
        std::vector<double> all(detail::size(n_cells()));
        detail::call([&](motet_error **error) { return motet_mesh_eas(get(), all.data(), n_cells(), error); });
        return all;
    }
    /// Counts, bounds, volumes, quality and defects as one JSON object, the one of `motet info --json`.
    std::string summary() const
    {
        const auto summary = detail::made<detail::owned_text>(
            [&](motet_text **place, motet_error **error) { return motet_mesh_summary(get(), place, error); });
        return detail::text(motet_text_get(summary.get()));
    }

private:
    template <std::size_t of_each>
    std::vector<std::array<std::int32_t, of_each>> of_kind(cell_kind kind) const
    {
        const std::vector<std::int32_t> flat = of_kind(kind, std::int32_t{of_each});
        std::vector<std::array<std::int32_t, of_each>> all(flat.size() / of_each);
        for (std::size_t i = 0; i < flat.size(); i++) all[i / of_each][i % of_each] = flat[i];
        return all;
    }

    static std::optional<std::int32_t> label(std::int32_t label)
    {
        if (label < 0) return std::nullopt;
        return label;
    }

    friend class mesh;
    const motet_mesh *mesh_;
};

/// Points, cells of any kinds, and arrays on them.
class mesh : public mesh_ref {
public:
    /// Points and no cells.
    explicit mesh(rows<const double> points)
        : mesh(detail::made<owned>([&](motet_mesh **place, motet_error **error) {
              return motet_mesh_new(points.data(), detail::count(points.size()), detail::count(points.stride()), place,
                                    error);
          }))
    {
    }
    /// Takes over a mesh of the C library.
    explicit mesh(motet_mesh *handle) noexcept : mesh_ref(handle), handle_(handle) {}
    mesh(mesh &&other) noexcept : mesh_ref(std::exchange(other.mesh_, nullptr)), handle_(std::move(other.handle_)) {}
    mesh &operator=(mesh &&other) noexcept
    {
        handle_ = std::move(other.handle_);
        mesh_ = handle_.get();
        other.mesh_ = other.handle_.get();
        return *this;
    }

    /// Reads a file; its suffix states the format.
    static mesh read(const std::string &path)
    {
        return mesh(detail::made<owned>(
            [&](motet_mesh **place, motet_error **error) { return motet_mesh_read(path.c_str(), place, error); }));
    }
    /// Reads a file; `notes` receives what of it is not used, a sentence each.
    static mesh read_noted(const std::string &path, std::vector<std::string> &notes)
    {
        motet_text *sentences = nullptr;
        mesh read(detail::made<owned>([&](motet_mesh **place, motet_error **error) {
            return motet_mesh_read_noted(path.c_str(), place, &sentences, error);
        }));
        const detail::owned_text freed(sentences);
        notes = detail::lines(motet_text_get(sentences));
        return read;
    }

    motet_mesh *get() noexcept { return handle_.get(); }
    using mesh_ref::get;

    /// Appends cells of one kind; `vertices` lists the vertices of each, `of_each`, cell after cell. On an error
    /// no cell is appended.
    void add_cells(cell_kind kind, view<const std::int32_t> vertices, std::size_t of_each)
    {
        if (of_each == 0 || vertices.size() % of_each != 0)
            detail::refuse(std::to_string(vertices.size()) + " vertices are not cells of " + std::to_string(of_each));
        detail::call([&](motet_error **error) {
            return motet_mesh_add_cells(get(), static_cast<std::int32_t>(kind), vertices.data(),
                                        detail::count(vertices.size() / of_each), error);
        });
    }
    /// Appends cells of one kind, an array of vertices for each.
    template <std::size_t of_each>
    void add_cells(cell_kind kind, const std::vector<std::array<std::int32_t, of_each>> &cells)
    {
        std::vector<std::int32_t> flat;
        flat.reserve(cells.size() * of_each);
        for (const auto &cell : cells) flat.insert(flat.end(), cell.begin(), cell.end());
        add_cells(kind, flat, of_each);
    }
    /// Sets the labels of all cells, in their order: regions of volume cells, patches of surface cells; 0 for none.
    void set_labels(view<const std::int32_t> labels)
    {
        detail::call([&](motet_error **error) {
            return motet_mesh_set_labels(get(), labels.data(), detail::count(labels.size()), error);
        });
    }
    /// Names the region that has a label.
    void name_region(std::int32_t label, const std::string &name)
    {
        detail::call([&](motet_error **error) { return motet_mesh_name_region(get(), label, name.c_str(), error); });
    }
    /// Names the patch that has a label.
    void name_patch(std::int32_t label, const std::string &name)
    {
        detail::call([&](motet_error **error) { return motet_mesh_name_patch(get(), label, name.c_str(), error); });
    }
    /// Sets an array with `components` values for each point or cell, row after row; replaces an array of the same
    /// name.
    void set_array(on where, const std::string &name, view<const double> values, std::int32_t components = 1);
    /// Moves all points.
    void set_points(rows<const double> points)
    {
        detail::call([&](motet_error **error) {
            return motet_mesh_set_points(get(), points.data(), detail::count(points.size()),
                                         detail::count(points.stride()), error);
        });
    }

private:
    using owned = detail::owned<motet_mesh, motet_mesh_free>;
    explicit mesh(owned handle) noexcept : mesh_ref(handle.get()), handle_(std::move(handle)) {}
    friend class mesh_ref;

    owned handle_;
};

inline mesh mesh_ref::copy() const
{
    return mesh(detail::made<mesh::owned>(
        [&](motet_mesh **place, motet_error **error) { return motet_mesh_copy(get(), place, error); }));
}

namespace detail {

/// The number of rows of `components` values.
inline std::int64_t n_rows(view<const double> values, std::int32_t components)
{
    if (components < 1 || values.size() % static_cast<std::size_t>(components) != 0)
        refuse(std::to_string(values.size()) + " values are not rows of " + std::to_string(components));
    return count(values.size()) / components;
}

/// Lists of names as C takes them.
class lists {
public:
    void set(const std::vector<std::string> &names, const char *const *&place, std::int64_t &n)
    {
        if (names.empty()) return;
        std::vector<const char *> &list = all_.emplace_back();
        for (const std::string &name : names) list.push_back(name.c_str());
        place = list.data();
        n = count(list.size());
    }

private:
    std::deque<std::vector<const char *>> all_;
};

inline motet_watch *handle_of(const watch *watch) { return watch ? watch->get() : nullptr; }

} // namespace detail

inline void mesh::set_array(on where, const std::string &name, view<const double> values, std::int32_t components)
{
    detail::call([&](motet_error **error) {
        return motet_mesh_set_array(get(), static_cast<std::int32_t>(where), name.c_str(), values.data(),
                                    detail::n_rows(values, components), components, error);
    });
}

// ---- Motion -----------------------------------------------------------------------------------------------

/// Methods of motion.
enum class motion_method : std::int32_t {
    delaunay = MOTET_DELAUNAY, ///< weights in the Delaunay graph of the boundary (Liu, Qin, Xia 2006): the cheapest
    bodies = MOTET_BODIES,     ///< rigid bodies carry the vertices around them: for parts that turn or shift far
    guided = MOTET_GUIDED,     ///< a graph with inner nodes and rotations: for walls that bend
    elastic = MOTET_ELASTIC,   ///< linear elasticity; for comparison
    laplace = MOTET_LAPLACE,   ///< a Laplace equation; for comparison
    idw = MOTET_IDW,           ///< inverse-distance weighting; for comparison
    rbf = MOTET_RBF            ///< radial basis functions; for comparison
};

/// Options of a mover.
struct mover_options {
    /// how vertices follow the boundary
    motion_method method = motion_method::delaunay;
    /// no vertex follows the wall of another lumen or the far side of a flap
    bool within_walls = false;
    /// number of sweeps over the vertices of bad tets after each step
    std::int32_t smooth = 0;
    /// largest number of sub-steps of an advance
    std::int32_t substeps = 50;
    /// 0: all cores; 1: the thread of the caller only
    std::int32_t threads = 1;
    /// thickness of the rigid layer in cells, whose vertices move rigidly with the wall
    std::int32_t rigid_layer_cells = 0;
    /// thickness of the rigid layer as a distance; 0: no layer
    double rigid_layer = 0;
    /// relative residual at which iterative solvers stop
    double residual = 1e-6;
    /// gibibytes that a factor of the matrix may take to be kept
    double factor_gib = 0;
    /// names (or labels as text) of flat patches whose vertices slide in their plane
    std::vector<std::string> slide{};
    /// names of patches that are rigid bodies; none: every separate part of the moved walls but the outer one
    std::vector<std::string> bodies{};
    /// names of patches that have the rigid layer; none: all of the boundary that does not slide
    std::vector<std::string> wall{};
    /// inner vertices that the caller moves as well
    std::vector<std::int32_t> also_moved{};
    /// largest distance of a vertex of a sliding patch from its plane, as a fraction of the radius of the patch
    double slide_tolerance = 0.05;
    /// tells the progress of calls and stops them
    watch *watched_by = nullptr;
};

namespace detail {

inline motet_mover_options given(const mover_options &options, lists &kept)
{
    motet_mover_options c;
    motet_mover_options_init(&c, sizeof c);
    c.method = static_cast<std::int32_t>(options.method);
    c.within_walls = options.within_walls;
    c.smooth = options.smooth;
    c.substeps = options.substeps;
    c.threads = options.threads;
    c.rigid_layer_cells = options.rigid_layer_cells;
    c.rigid_layer = options.rigid_layer;
    c.residual = options.residual;
    c.factor_gib = options.factor_gib;
    kept.set(options.slide, c.slide, c.n_slide);
    kept.set(options.bodies, c.bodies, c.n_bodies);
    kept.set(options.wall, c.wall, c.n_wall);
    c.also_moved = options.also_moved.data();
    c.n_also_moved = count(options.also_moved.size());
    c.slide_tolerance = options.slide_tolerance;
    c.watched_by = handle_of(options.watched_by);
    return c;
}

} // namespace detail

/// What an advance reached: `complete`, `fraction`, `inverted`, `bad`, `worst_eas` and others, as in motet.h.
using certificate = motet_certificate;

/// The four vertices that a vertex follows, and their weights.
struct vertex_weights {
    std::array<std::int32_t, 4> vertices;
    std::array<double, 4> weights;
};

/// Moves the vertices of one mesh with its boundary.
class mover {
public:
    explicit mover(mesh_ref mesh, const mover_options &options = {}) : listener_(listener_of(options.watched_by))
    {
        detail::lists kept;
        const motet_mover_options c = detail::given(options, kept);
        handle_ = detail::made<owned>(listener_, [&](motet_mover **place, motet_error **error) {
            return motet_mover_new(mesh.get(), &c, place, error);
        });
    }

    std::int64_t n_points() const noexcept { return motet_mover_n_points(get()); }
    /// The number of vertices that the caller moves: those of the boundary, and also_moved.
    std::int64_t n_boundary() const noexcept { return motet_mover_n_boundary(get()); }
    /// The vertices that the caller moves, in ascending order.
    std::vector<std::int32_t> boundary() const
    {
        std::vector<std::int32_t> all(detail::size(n_boundary()));
        detail::call([&](motet_error **error) { return motet_mover_boundary(get(), all.data(), n_boundary(), error); });
        return all;
    }
    /// The four vertices that a vertex follows and their weights; none for a vertex that follows something else.
    std::optional<vertex_weights> weights(std::int32_t vertex) const
    {
        vertex_weights found{};
        std::int32_t is_hanging = 0;
        detail::call([&](motet_error **error) {
            return motet_mover_weights(get(), vertex, found.vertices.data(), found.weights.data(), &is_hanging, error);
        });
        if (is_hanging == 0) return std::nullopt;
        return found;
    }
    /// Moves the mesh from its first place. `displacement` has a row for each moved vertex, `points` receives the
    /// place of every vertex. Nothing but counts and finiteness is checked.
    void step(rows<const double> displacement, rows<double> points) const
    {
        detail::call([&](motet_error **error) {
            return motet_mover_step(get(), displacement.data(), detail::count(displacement.size()),
                                    detail::count(displacement.stride()), points.data(), detail::count(points.size()),
                                    detail::count(points.stride()), error);
        });
    }
    /// Moves the mesh from its first place, in sub-steps where necessary: no cell that was not inverted at first is
    /// inverted at the end. A motion that is reached in part only is no error. After an error `points` may have
    /// changed.
    certificate advance(rows<const double> displacement, rows<double> points)
    {
        certificate reached;
        motet_certificate_init(&reached, sizeof reached);
        detail::watched(listener_, [&](motet_error **error) {
            return motet_mover_advance(get(), displacement.data(), detail::count(displacement.size()),
                                       detail::count(displacement.stride()), points.data(),
                                       detail::count(points.size()), detail::count(points.stride()), &reached, error);
        });
        return reached;
    }

    motet_mover *get() const noexcept { return handle_.get(); }

private:
    using owned = detail::owned<motet_mover, motet_mover_free>;
    detail::listener listener_;
    owned handle_;
};

/// Moves points with nodes, without a mesh: for processes that hold a part of a mesh each.
class point_mover {
public:
    /// `nodes` are those of the whole boundary, of all processes, in any order.
    point_mover(rows<const double> nodes, rows<const double> points, std::int32_t threads = 1)
        : handle_(detail::made<owned>([&](motet_point_mover **place, motet_error **error) {
              return motet_point_mover_new(nodes.data(), detail::count(nodes.size()), detail::count(nodes.stride()),
                                           points.data(), detail::count(points.size()), detail::count(points.stride()),
                                           threads, place, error);
          }))
    {
    }
    /// Moves the points from their first places. `displacement` has a row for each node, `points` receives the
    /// places.
    void step(rows<const double> displacement, rows<double> points) const
    {
        detail::call([&](motet_error **error) {
            return motet_point_mover_step(get(), displacement.data(), detail::count(displacement.size()),
                                          detail::count(displacement.stride()), points.data(),
                                          detail::count(points.size()), detail::count(points.stride()), error);
        });
    }

    motet_point_mover *get() const noexcept { return handle_.get(); }

private:
    using owned = detail::owned<motet_point_mover, motet_point_mover_free>;
    owned handle_;
};

// ---- Changes of a mesh ------------------------------------------------------------------------------------

/// How an array is transferred from the old mesh to the new one.
enum class transfer_rule : std::int32_t {
    mean = MOTET_RULE_MEAN,       ///< on points: interpolated; on cells: averaged by volume, so that integrals are kept
    inherit = MOTET_RULE_INHERIT, ///< the value of the old point or cell with the largest share
    linear = MOTET_RULE_LINEAR    ///< on points: linear in each old tet; on cells: as mean
};

/// A new mesh, the origins of its points and cells, and a report.
class outcome {
public:
    /// Takes over an outcome of the C library.
    explicit outcome(motet_outcome *handle) noexcept : handle_(handle) {}

    /// Whether the requested result was reached.
    bool complete() const noexcept { return motet_outcome_complete(get()) == 1; }
    /// The new mesh.
    mesh_ref mesh() const noexcept { return mesh_ref(motet_outcome_mesh(get())); }
    /// The report as one JSON object.
    std::string report() const { return detail::text(motet_outcome_report(get())); }
    /// Why the requested result was not reached; none where it was.
    std::optional<std::string> not_reached() const { return detail::optional_text(motet_outcome_not_reached(get())); }
    /// For each new point or cell: the old one that it equals to the bit; -1 for those that are new.
    std::vector<std::int32_t> to_old(on where) const
    {
        std::vector<std::int32_t> old(detail::size(n(where)));
        detail::call([&](motet_error **error) {
            return motet_outcome_to_old(get(), static_cast<std::int32_t>(where), old.data(), n(where), error);
        });
        return old;
    }
    /// Transfers an array of the old mesh, `components` values for each point or cell, row after row.
    std::vector<double> transfer(on where, transfer_rule rule, view<const double> values,
                                 std::int32_t components = 1) const
    {
        const std::int64_t n_old = detail::n_rows(values, components);
        std::vector<double> out(detail::size(n(where) * components));
        detail::call([&](motet_error **error) {
            return motet_outcome_transfer(get(), static_cast<std::int32_t>(where), static_cast<std::int32_t>(rule),
                                          values.data(), n_old, components, out.data(), n(where), error);
        });
        return out;
    }

    motet_outcome *get() const noexcept { return handle_.get(); }

private:
    std::int64_t n(on where) const noexcept { return where == on::points ? mesh().n_points() : mesh().n_cells(); }

    detail::owned<motet_outcome, motet_outcome_free> handle_;
};

namespace detail {

using owned_outcome = owned<motet_outcome, motet_outcome_free>;

template <class Call>
outcome made_outcome(const listener &by, Call &&make)
{
    return outcome(made<owned_outcome>(by, make).release());
}

} // namespace detail

/// What a repair may do to walls: boundary, interfaces, labelled facets.
enum class surface_rule : std::int32_t {
    keep = MOTET_SURFACE_KEEP,   ///< walls are kept to the bit
    adapt = MOTET_SURFACE_ADAPT, ///< walls change within a distance; features are kept
    loose = MOTET_SURFACE_LOOSE  ///< walls change within a distance; features change as well where nothing else helps
};

/// Options of a repair.
struct remesh_options {
    /// tets with a lower EAS are bad
    double min_eas = 0.2;
    /// tets with a smaller dihedral angle are bad as well, in degrees
    double min_dihedral_deg = 0;
    /// all tets are improved, not the bad ones only
    bool best = false;
    /// what happens to walls
    surface_rule surface = surface_rule::keep;
    /// how far walls may stray; 0: a thousandth of the largest extent
    double distance = 0;
    /// thin tets of boundary layers are repaired as others are
    bool repair_layers = false;
    /// largest number of rounds
    std::int32_t rounds = 20;
    /// 0: all cores; 1: the thread of the caller only
    std::int32_t threads = 0;
    /// requested length of all edges; 0: edges keep their lengths
    double edge_length = 0;
    /// requested length of edges at each point
    std::vector<double> sizes{};
    /// names (or labels as text) of regions and patches that are kept to the bit
    std::vector<std::string> hold{};
    /// tells the progress and stops the call
    watch *watched_by = nullptr;
};

/// What becomes of the space inside a device.
enum class inside_rule : std::int32_t {
    own = MOTET_INSIDE_OWN,       ///< devices keep their tets; devices that are surfaces are filled
    filled = MOTET_INSIDE_FILLED, ///< all devices are filled with new tets
    hollow = MOTET_INSIDE_HOLLOW  ///< no tets: the surface of the device bounds the mesh
};

/// What of the host is refined before the implantation.
enum class adapt_rule : std::int32_t {
    no = MOTET_ADAPT_NO,       ///< nothing
    walls = MOTET_ADAPT_WALLS, ///< walls near the devices
    all = MOTET_ADAPT_ALL      ///< all tets near the devices
};

/// Options of an implantation.
struct implant_options {
    /// the space inside devices
    inside_rule inside = inside_rule::own;
    /// devices get a new surface near theirs, for surfaces that touch or cross themselves
    bool conform = false;
    /// with conform: largest distance of the new surface from that of the device; 0: a fifth of the radius of a
    /// wire as thick as the device
    double tolerance = 0;
    /// the parts of devices outside of the host are kept, not cut off
    bool keep_outside = false;
    /// what is refined first
    adapt_rule adapt = adapt_rule::walls;
    /// how far surfaces may stray where a device meets a wall; -1: a twentieth of the edge length of the device
    double stray = -1;
    /// length of edges beside the devices; 0: as those of the devices
    double edge_length = 0;
    /// growth of lengths per unit of distance from the devices
    double growth = 0.5;
    /// tets nearer to a device than this number of edge lengths are replaced
    double carve = 1;
    /// tets farther than this number of edge lengths are kept to the bit
    double reach = 3;
    /// tets with a lower EAS are repaired
    double min_eas = 0.2;
    /// 0: all cores; 1: the thread of the caller only
    std::int32_t threads = 0;
    /// tells the progress and stops the call
    watch *watched_by = nullptr;
};

/// Options of filling.
struct fill_options {
    /// length of inner edges, the largest where sizes grow; 0: only necessary points
    double edge_length = 0;
    /// lengths are those of the surface and grow inwards
    bool graded = false;
    /// growth of lengths per unit of distance; 0: 0.3
    double growth = 0;
    /// tets with a lower EAS are repaired; 0: 0.2 with sizes, no repair without
    double min_eas = 0;
    /// number of thin layers on walls
    std::int32_t layers = 0;
    /// thickness of the first layer
    double first_layer = 0;
    /// ratio of the thicknesses of a layer and the one before
    double layer_growth = 1.2;
    /// layers are wedges and pyramids, not divided into tets
    bool keep_prisms = false;
    /// T-junctions, coincident faces, duplicates, orientation and small holes are repaired first
    bool repair = false;
    /// 0: all cores; 1: the thread of the caller only
    std::int32_t threads = 0;
    /// surfaces that cross are divided along their intersection
    bool cut = false;
    /// spaces inside closed surfaces that are turned inward stay empty
    bool voids = false;
    /// tells the progress and stops the call
    watch *watched_by = nullptr;
    /// bodies that cross, touch or lie on each other become one, without what lies inside
    bool unite = false;
    /// the surfaces are replaced by a closed one within this distance, around what they enclose; 0: they are not
    double wrap = 0;
};

/// Options of a refinement.
struct refinement_options {
    /// 0: all cores; 1: the thread of the caller only
    std::int32_t threads = 0;
    /// tells the progress of calls and stops them
    watch *watched_by = nullptr;
};

namespace detail {

inline motet_remesh_options given(const remesh_options &options, lists &kept)
{
    motet_remesh_options c;
    motet_remesh_options_init(&c, sizeof c);
    c.min_eas = options.min_eas;
    c.min_dihedral_deg = options.min_dihedral_deg;
    c.best = options.best;
    c.surface = static_cast<std::int32_t>(options.surface);
    c.distance = options.distance;
    c.repair_layers = options.repair_layers;
    c.rounds = options.rounds;
    c.threads = options.threads;
    c.edge_length = options.edge_length;
    if (!options.sizes.empty()) c.sizes = options.sizes.data();
    c.n_sizes = count(options.sizes.size());
    kept.set(options.hold, c.hold, c.n_hold);
    c.watched_by = handle_of(options.watched_by);
    return c;
}

inline motet_implant_options given(const implant_options &options, lists &)
{
    motet_implant_options c;
    motet_implant_options_init(&c, sizeof c);
    c.inside = static_cast<std::int32_t>(options.inside);
    c.conform = options.conform;
    c.tolerance = options.tolerance;
    c.keep_outside = options.keep_outside;
    c.adapt = static_cast<std::int32_t>(options.adapt);
    c.stray = options.stray;
    c.edge_length = options.edge_length;
    c.growth = options.growth;
    c.carve = options.carve;
    c.reach = options.reach;
    c.min_eas = options.min_eas;
    c.threads = options.threads;
    c.watched_by = handle_of(options.watched_by);
    return c;
}

inline motet_fill_options given(const fill_options &options, lists &)
{
    motet_fill_options c;
    motet_fill_options_init(&c, sizeof c);
    c.edge_length = options.edge_length;
    c.graded = options.graded;
    c.growth = options.growth;
    c.min_eas = options.min_eas;
    c.layers = options.layers;
    c.first_layer = options.first_layer;
    c.layer_growth = options.layer_growth;
    c.keep_prisms = options.keep_prisms;
    c.repair = options.repair;
    c.threads = options.threads;
    c.cut = options.cut;
    c.voids = options.voids;
    c.watched_by = handle_of(options.watched_by);
    c.unite = options.unite;
    c.wrap = options.wrap;
    return c;
}

inline motet_refinement_options given(const refinement_options &options, lists &)
{
    motet_refinement_options c;
    motet_refinement_options_init(&c, sizeof c);
    c.threads = options.threads;
    c.watched_by = handle_of(options.watched_by);
    return c;
}

} // namespace detail

/// Repairs the bad tets of a mesh, and these only unless options say otherwise.
inline outcome remesh(mesh_ref mesh, const remesh_options &options = {})
{
    detail::lists kept;
    const motet_remesh_options c = detail::given(options, kept);
    return detail::made_outcome(listener_of(options.watched_by), [&](motet_outcome **place, motet_error **error) {
        return motet_remesh(mesh.get(), &c, place, error);
    });
}

/// A device and the name of its region and its patch.
struct device {
    mesh_ref mesh;
    std::string name;
};

/// Puts devices into a host.
inline outcome implant(mesh_ref host, const std::vector<device> &devices, const implant_options &options = {})
{
    detail::lists kept;
    const motet_implant_options c = detail::given(options, kept);
    std::vector<const motet_mesh *> meshes;
    std::vector<const char *> names;
    for (const device &one : devices) meshes.push_back(one.mesh.get()), names.push_back(one.name.c_str());
    return detail::made_outcome(listener_of(options.watched_by), [&](motet_outcome **place, motet_error **error) {
        return motet_implant(host.get(), meshes.data(), names.data(), detail::count(devices.size()), &c, place,
                             error);
    });
}

/// A surface that is filled, and its name.
struct surface {
    mesh_ref mesh;
    std::string name;
    bool is_membrane = false; ///< may end inside the others
};

/// Fills closed surfaces with tets. The outcome has no history.
inline outcome fill(const std::vector<surface> &surfaces, const fill_options &options = {})
{
    detail::lists kept;
    const motet_fill_options c = detail::given(options, kept);
    std::vector<const motet_mesh *> meshes;
    std::vector<const char *> names;
    std::vector<std::int32_t> is_membrane;
    for (const surface &one : surfaces) {
        meshes.push_back(one.mesh.get());
        names.push_back(one.name.c_str());
        is_membrane.push_back(one.is_membrane);
    }
    return detail::made_outcome(listener_of(options.watched_by), [&](motet_outcome **place, motet_error **error) {
        return motet_fill(meshes.data(), names.data(), is_membrane.data(), detail::count(surfaces.size()), &c, place,
                          error);
    });
}

/// A mesh whose tets are divided over many steps, and whose divisions are taken back.
class refinement {
public:
    explicit refinement(mesh_ref mesh, const refinement_options &options = {})
        : listener_(listener_of(options.watched_by))
    {
        detail::lists kept;
        const motet_refinement_options c = detail::given(options, kept);
        handle_ = detail::made<owned>(listener_, [&](motet_refinement **place, motet_error **error) {
            return motet_refinement_new(mesh.get(), &c, place, error);
        });
    }

    /// The current mesh.
    mesh_ref mesh() const noexcept { return mesh_ref(motet_refinement_mesh(get())); }
    /// The number of divisions of each cell; -1 for cells that are not tets.
    std::vector<std::int32_t> generations() const
    {
        std::vector<std::int32_t> all(detail::size(mesh().n_cells()));
        detail::call([&](motet_error **error) {
            return motet_refinement_generations(get(), all.data(), detail::count(all.size()), error);
        });
        return all;
    }
    /// Divides the tets whose mark is not 0, and further tets where conformity requires it; `marks` has one for
    /// each cell. The outcome has a copy of the mesh and the history.
    outcome divide(view<const std::int32_t> marks)
    {
        return detail::made_outcome(nullptr, [&](motet_outcome **place, motet_error **error) {
            return motet_refinement_divide(get(), marks.data(), detail::count(marks.size()), place, error);
        });
    }
    /// Takes back the divisions of which all parts have a mark that is not 0.
    outcome coarsen(view<const std::int32_t> marks)
    {
        return detail::made_outcome(nullptr, [&](motet_outcome **place, motet_error **error) {
            return motet_refinement_coarsen(get(), marks.data(), detail::count(marks.size()), place, error);
        });
    }
    /// Divides tets until no edge is longer than `at` at a surface, and `growth` more per unit of distance from it.
    outcome near(mesh_ref surface, double at, double growth)
    {
        return detail::made_outcome(listener_, [&](motet_outcome **place, motet_error **error) {
            return motet_refinement_near(get(), surface.get(), at, growth, place, error);
        });
    }

    motet_refinement *get() const noexcept { return handle_.get(); }

private:
    using owned = detail::owned<motet_refinement, motet_refinement_free>;
    detail::listener listener_;
    owned handle_;
};

// ---- Contact ----------------------------------------------------------------------------------------------

/// Whether a body is the wall of a room that contains other bodies.
enum class room_rule : std::int32_t {
    found = MOTET_ROOM_FOUND, ///< a closed surface that encloses most of the area of another body is its room
    no = MOTET_ROOM_NO,       ///< a body, not a room
    yes = MOTET_ROOM_YES      ///< a room that contains the others
};

/// Options of contact.
struct contact_options {
    /// vertices with a smaller gap warn; 0: none
    double warn = 0;
    /// largest distance that is searched; 0: no limit
    double within = 0;
    /// two places of one surface are neighbours, without a gap, if the way along the surface is shorter than
    /// this many times the straight distance
    double fold = 3;
    /// each surface is measured against itself as well
    bool own = false;
    /// only surfaces that face each other through free space
    bool facing = false;
    /// 0: all cores; 1: the thread of the caller only
    std::int32_t threads = 0;
};

namespace detail {

inline motet_contact_options given(const contact_options &options, lists &)
{
    motet_contact_options c;
    motet_contact_options_init(&c, sizeof c);
    c.warn = options.warn;
    c.within = options.within;
    c.fold = options.fold;
    c.own = options.own;
    c.facing = options.facing;
    c.threads = options.threads;
    return c;
}

} // namespace detail

/// A surface that may touch others.
struct body {
    std::vector<std::array<std::int32_t, 3>> triangles; ///< the vertices of each
    room_rule is_room = room_rule::found;
};

/// The gap at each point, and the least distance of any two triangles.
struct gaps {
    /// Infinite for points of no body and where nothing is within reach; negative where a body is where it must not
    /// be.
    std::vector<double> at_points;
    double least = 0;
};

/// The closest points of two bodies.
struct nearest_points {
    double distance = 0; ///< infinite where nothing is within reach; then the others have no meaning
    std::array<point, 2> places{};
    std::array<std::int32_t, 2> triangles{};
};

/// Surfaces over one list of points, whose distances are measured.
class contact {
public:
    contact(rows<const double> points, const std::vector<body> &bodies, const contact_options &options = {})
        : n_points_(detail::count(points.size()))
    {
        std::vector<std::int32_t> triangles, is_room;
        std::vector<std::int64_t> counts;
        for (const body &one : bodies) {
            for (const auto &triangle : one.triangles)
                triangles.insert(triangles.end(), triangle.begin(), triangle.end());
            counts.push_back(detail::count(one.triangles.size()));
            is_room.push_back(static_cast<std::int32_t>(one.is_room));
        }
        detail::lists kept;
        const motet_contact_options c = detail::given(options, kept);
        handle_ = detail::made<owned>([&](motet_contact **place, motet_error **error) {
            return motet_contact_new(points.data(), n_points_, detail::count(points.stride()), triangles.data(),
                                     counts.data(), is_room.data(), detail::count(bodies.size()), &c, place, error);
        });
    }

    /// Moves all points.
    void refit(rows<const double> points)
    {
        detail::call([&](motet_error **error) {
            return motet_contact_refit(get(), points.data(), detail::count(points.size()),
                                       detail::count(points.stride()), error);
        });
    }
    /// Measures the gap at each point: the least of the gaps of its bodies.
    gaps measure()
    {
        gaps measured;
        measured.at_points.resize(detail::size(n_points_));
        detail::call([&](motet_error **error) {
            return motet_contact_measure(get(), measured.at_points.data(), n_points_, &measured.least, error);
        });
        return measured;
    }
    /// Finds the closest points of two bodies.
    nearest_points nearest(std::int32_t first, std::int32_t second)
    {
        nearest_points found;
        std::array<double, 6> places{};
        detail::call([&](motet_error **error) {
            return motet_contact_nearest(get(), first, second, &found.distance, places.data(), found.triangles.data(),
                                         error);
        });
        for (std::size_t i = 0; i < 6; i++) found.places[i / 3][i % 3] = places[i];
        return found;
    }
    /// A time before which nothing touches if points move straight on at their velocities, one row for each point;
    /// infinite where nothing touches before the horizon (0: no horizon).
    double ahead(rows<const double> velocity, double horizon = 0) const
    {
        double time = 0;
        detail::call([&](motet_error **error) {
            return motet_contact_ahead(get(), velocity.data(), detail::count(velocity.size()),
                                       detail::count(velocity.stride()), horizon, &time, error);
        });
        return time;
    }

    motet_contact *get() const noexcept { return handle_.get(); }

private:
    using owned = detail::owned<motet_contact, motet_contact_free>;
    owned handle_;
    std::int64_t n_points_;
};

// ---- Moving meshes ----------------------------------------------------------------------------------------

/// Options of a moving mesh.
struct moving_options {
    /// how vertices follow the walls
    motion_method method = motion_method::delaunay;
    /// no vertex follows the wall of another lumen or the far side of a flap
    bool within_walls = false;
    /// number of sweeps over the vertices of bad tets after each step
    std::int32_t smooth = 0;
    /// thickness of the rigid layer in cells; 0: no layer
    std::int32_t rigid_layer_cells = 0;
    /// thickness of the rigid layer as a distance; 0: no layer
    double rigid_layer = 0;
    /// names (or labels as text) of patches inside the volume that are driven, such as a flap
    std::vector<std::string> inside{};
    /// names of flat patches whose vertices slide in their plane
    std::vector<std::string> slide{};
    /// names of patches that are rigid bodies; none: every separate part of the moved walls but the outer one
    std::vector<std::string> bodies{};
    /// names of patches that have the rigid layer; none: all of the boundary that does not slide
    std::vector<std::string> wall{};
    /// nothing is repaired, and a step stops before a cell is inverted
    bool no_repair = false;
    /// what a repair does to walls
    surface_rule surface = surface_rule::keep;
    /// how far walls may stray; 0: a thousandth of the largest extent
    double distance = 0;
    /// tets with a lower EAS are bad
    double min_eas = 0.2;
    /// a repair aims at an EAS of min_eas plus this
    double margin = 0.05;
    /// no step takes a tet that can be repaired below this EAS
    double floor = 0.05;
    /// where a repair changes the mesh, tets with a lower EAS are improved as well and the number of vertices
    /// is kept; 0: only bad tets change
    double improve_below = 0.75;
    /// names of cell arrays that are densities of something that stays in its cell: their integrals are kept
    std::vector<std::string> contents{};
    /// names of patches whose gaps are measured at each step
    std::vector<std::string> watch{};
    /// vertices with a smaller gap warn; 0: none
    double warn = 0;
    /// largest distance that is searched; 0: no limit
    double within = 0;
    /// how far contact is predicted, in units of time; 0: the duration of the last step
    double horizon = 0;
    /// walls stop at this distance from each other, whatever displacement is requested; 0: they do not stop
    double hold = 0;
    /// number of changes that are kept for moving::since
    std::int32_t remembered = 64;
    /// 0: all cores; 1: the thread of the caller only
    std::int32_t threads = 0;
    /// names of regions and patches that a repair keeps to the bit
    std::vector<std::string> hold_names{};
    /// largest distance of a vertex of a sliding patch from its plane, as a fraction of the radius of the patch
    double slide_tolerance = 0.05;
    /// new tets must have a volume also where their vertices were at the start of the step
    bool valid_at_start = false;
    /// with motion_method::bodies a band beside the bodies takes the strain, for bodies that go on in one
    /// direction
    bool strain_in_band = false;
    /// the walls return to their first places again and again
    bool returns = false;
    /// tells the progress of calls and stops them
    motet::watch *watched_by = nullptr;
};

namespace detail {

inline motet_moving_options given(const moving_options &options, lists &kept)
{
    motet_moving_options c;
    motet_moving_options_init(&c, sizeof c);
    c.method = static_cast<std::int32_t>(options.method);
    c.within_walls = options.within_walls;
    c.smooth = options.smooth;
    c.rigid_layer_cells = options.rigid_layer_cells;
    c.rigid_layer = options.rigid_layer;
    kept.set(options.inside, c.inside, c.n_inside);
    kept.set(options.slide, c.slide, c.n_slide);
    kept.set(options.bodies, c.bodies, c.n_bodies);
    kept.set(options.wall, c.wall, c.n_wall);
    c.no_repair = options.no_repair;
    c.surface = static_cast<std::int32_t>(options.surface);
    c.distance = options.distance;
    c.min_eas = options.min_eas;
    c.margin = options.margin;
    c.floor = options.floor;
    c.improve_below = options.improve_below;
    kept.set(options.contents, c.contents, c.n_contents);
    kept.set(options.watch, c.watch, c.n_watch);
    c.warn = options.warn;
    c.within = options.within;
    c.horizon = options.horizon;
    c.hold = options.hold;
    c.remembered = options.remembered;
    c.threads = options.threads;
    kept.set(options.hold_names, c.hold_names, c.n_hold_names);
    c.slide_tolerance = options.slide_tolerance;
    c.valid_at_start = options.valid_at_start;
    c.strain_in_band = options.strain_in_band;
    c.returns = options.returns;
    c.watched_by = handle_of(options.watched_by);
    return c;
}

} // namespace detail

/// The result of a step: `complete`, `changes`, `points`, `bad`, `worst_eas`, `gap` and others, as in motet.h.
using moving_step = motet_step;

/// A mesh that moves with its walls and stays good: certified, repaired while bad tets still have a volume,
/// refined, watched; its arrays are transferred where it changes. Displacements are those of the walls of the
/// first mesh, from their first places, whatever the mesh becomes.
class moving {
public:
    explicit moving(mesh_ref mesh, const moving_options &options = {})
        : moving(options, [&](const motet_moving_options &c, motet_moving **place, motet_error **error) {
              return motet_moving_new(mesh.get(), &c, place, error);
          })
    {
    }
    /// Continues from a file of `save`: with the same options, later steps are the same to the bit. Earlier changes
    /// are not remembered.
    static moving load(const std::string &path, const moving_options &options = {})
    {
        return moving(options, [&](const motet_moving_options &c, motet_moving **place, motet_error **error) {
            return motet_moving_load(path.c_str(), &c, place, error);
        });
    }
    /// Writes all that later steps depend on to a .vtu file.
    void save(const std::string &path) const
    {
        detail::call([&](motet_error **error) { return motet_moving_save(get(), path.c_str(), error); });
    }

    /// The number of driven vertices: those of the boundary and of the patches `inside` of the first mesh.
    std::int64_t n_driven() const noexcept { return motet_moving_n_driven(get()); }
    /// The first places of the driven vertices. Displacements have a row for each of these, in this order.
    std::vector<point> driven_places() const
    {
        return points_of(n_driven(), [&](double *out, std::int64_t n, motet_error **error) {
            return motet_moving_driven_places(get(), out, n, 3, error);
        });
    }
    /// The current time; 0 at first.
    double time() const noexcept { return motet_moving_time(get()); }
    /// The number of steps so far.
    std::int64_t step() const noexcept { return motet_moving_step(get()); }
    /// The current mesh with its arrays.
    mesh_ref mesh() const noexcept { return mesh_ref(motet_moving_mesh(get())); }
    /// The velocity of each point of the current mesh in the last step.
    std::vector<point> velocity() const
    {
        return points_of(mesh().n_points(), [&](double *out, std::int64_t n, motet_error **error) {
            return motet_moving_velocity(get(), out, n, 3, error);
        });
    }
    /// The displacement of each point of the current mesh from its first place.
    std::vector<point> displacement() const
    {
        return points_of(mesh().n_points(), [&](double *out, std::int64_t n, motet_error **error) {
            return motet_moving_displacement(get(), out, n, 3, error);
        });
    }
    /// Sets an array with `components` values for each point or cell, row after row; replaces an array of the same
    /// name. It is transferred where the mesh changes.
    void set_array(on where, const std::string &name, view<const double> values, std::int32_t components = 1)
    {
        detail::call([&](motet_error **error) {
            return motet_moving_set_array(get(), static_cast<std::int32_t>(where), name.c_str(), values.data(),
                                          detail::n_rows(values, components), components, error);
        });
    }

    /// Moves the walls to their displacements at a time after the current one, one row for each driven vertex; the
    /// inside follows and is repaired on the way where necessary. A motion that is reached in part only is no
    /// error.
    moving_step advance(double time, rows<const double> displacement)
    {
        moving_step reached;
        motet_step_init(&reached, sizeof reached);
        detail::watched(listener_, [&](motet_error **error) {
            return motet_moving_advance(get(), time, displacement.data(), detail::count(displacement.size()),
                                        detail::count(displacement.stride()), &reached, error);
        });
        return reached;
    }
    /// Repairs the bad tets of the current mesh, for a mesh that is bad at first or after refinement; a step repairs
    /// by itself. Returns the number of changes.
    std::int64_t repair()
    {
        return changes(
            [&](std::int64_t *changes, motet_error **error) { return motet_moving_repair(get(), changes, error); });
    }
    /// Divides tets until no edge is longer than `at` at a surface, and `growth` more per unit of distance from it;
    /// `coarsen`: divisions that are not needed are taken back. Returns the number of changes.
    std::int64_t refine_near(mesh_ref surface, double at, double growth, bool coarsen)
    {
        return changes([&](std::int64_t *changes, motet_error **error) {
            return motet_moving_refine_near(get(), surface.get(), at, growth, coarsen, changes, error);
        });
    }
    /// Divides tets until edges at watched patches are no longer than the gap between them or than `smallest`;
    /// `coarsen`: divisions that are not needed are taken back. Returns the number of changes.
    std::int64_t refine_gaps(double smallest, bool coarsen)
    {
        return changes([&](std::int64_t *changes, motet_error **error) {
            return motet_moving_refine_gaps(get(), smallest, coarsen, changes, error);
        });
    }

    /// Whether all changes since a step are remembered (step 0: since the first mesh).
    bool remembers(std::int64_t step) const noexcept { return motet_moving_remembers(get(), step) == 1; }
    /// The history from the mesh after a step to the current mesh: transfers any array of the caller by
    /// outcome::transfer. None where the mesh did not change, so that arrays fit as they are.
    std::optional<outcome> since(std::int64_t step) const
    {
        auto changes = detail::made<detail::owned_outcome>([&](motet_outcome **place, motet_error **error) {
            return motet_moving_since(get(), step, place, error);
        });
        if (!changes) return std::nullopt;
        return outcome(changes.release());
    }

    motet_moving *get() const noexcept { return handle_.get(); }

private:
    using owned = detail::owned<motet_moving, motet_moving_free>;

    template <class Make>
    moving(const moving_options &options, Make &&make) : listener_(listener_of(options.watched_by))
    {
        detail::lists kept;
        const motet_moving_options c = detail::given(options, kept);
        handle_ = detail::made<owned>(
            listener_, [&](motet_moving **place, motet_error **error) { return make(c, place, error); });
    }

    template <class Call>
    static std::vector<point> points_of(std::int64_t n, Call &&make)
    {
        std::vector<point> all(detail::size(n));
        const rows<double> out(all);
        detail::call([&](motet_error **error) { return make(out.data(), n, error); });
        return all;
    }

    template <class Call>
    std::int64_t changes(Call &&make)
    {
        std::int64_t n = 0;
        detail::watched(listener_, [&](motet_error **error) { return make(&n, error); });
        return n;
    }

    detail::listener listener_;
    owned handle_;
};

} // namespace motet

#endif
