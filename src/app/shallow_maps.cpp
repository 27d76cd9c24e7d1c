#include "app/shallow_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"
#include "io/csv.hpp"
#include "io/vtk.hpp"

namespace bagnold::app {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::size_t flat(const shallow::Grid& g, int i, int j) {
  return static_cast<std::size_t>(j) * static_cast<std::size_t>(g.nx) + static_cast<std::size_t>(i);
}

// Speed along the ground, of which (u, v) is the horizontal part on terrain.
double speed_of(const ShallowInput& in, std::size_t padded, double u, double v) {
  const shallow::Solver& s = in.solver;
  const double w = s.setup.terrain ? u * s.bed_x[padded] + v * s.bed_y[padded] : 0;
  return std::sqrt(u * u + v * v + w * w);
}

double discharge(const ShallowInput& in, const ShallowMaps& maps, const CrossSection& line) {
  const shallow::Grid& g = in.solver.setup.grid;
  const double length = std::hypot(line.x2 - line.x1, line.y2 - line.y1);
  const int points = std::max(2, static_cast<int>(std::ceil(2 * length / std::min(g.dx, g.dy))));
  const double nx = (line.y2 - line.y1) / length, ny = -(line.x2 - line.x1) / length;  // to the right of the line
  double sum = 0;
  for (int k = 0; k < points; ++k) {
    const double s = (k + 0.5) / points;
    const int i = std::clamp(static_cast<int>((line.x1 + s * (line.x2 - line.x1) - g.x0) / g.dx), 0, g.nx - 1);
    const int j = std::clamp(static_cast<int>((line.y1 + s * (line.y2 - line.y1) - g.y0) / g.dy), 0, g.ny - 1);
    const std::size_t c = flat(g, i, j);
    const double area = in.solver.setup.terrain ? in.solver.area[g.at(i, j)] : 1;
    sum += area * maps.h[c] * (maps.u[c] * nx + maps.v[c] * ny);
  }
  return sum * length / points;
}

}  // namespace

void start_maps(const ShallowInput& in, ShallowMaps& m) {
  const shallow::Grid& g = in.solver.setup.grid;
  const auto size = static_cast<std::size_t>(g.nx) * static_cast<std::size_t>(g.ny);
  for (auto* field : {&m.max_h, &m.max_speed, &m.max_pressure, &m.outside, &m.h, &m.u, &m.v}) field->assign(size, 0.0);
  m.arrival.assign(size, nan);
  m.smallest_h = std::numeric_limits<double>::infinity();
  m.largest_h = 0;
  observe(in, m);
  look(in, m);
}

namespace {

struct Extremes {
  double smallest_h = std::numeric_limits<double>::infinity(), largest_h = 0;
};

// One row of a box. `law` is the friction law without its static branch.
template <class Law>
void observe_row(const ShallowInput& in, const Law& law, const shallow::Tile& box, int j, shallow::CellRow& row,
                 ShallowMaps& m, Extremes& extremes) {
  const shallow::Solver& s = in.solver;
  const shallow::Grid& g = s.setup.grid;
  const closure::Validity& range = s.closure.set.validity;
  const double mu_lo = laws::tan_deg(range.theta_lo_deg), mu_hi = laws::tan_deg(range.theta_hi_deg);
  shallow::view_cells(s, in.state, box.i0, j, box.nx, row);
  Pack smallest = extremes.smallest_h, largest = extremes.largest_h;
  for (int k = 0; k < box.nx; k += Pack::lanes) {
    const std::size_t padded = g.at(box.i0 + k, j), c = flat(g, box.i0 + k, j);
    const Mask cells = lanes_between(0, box.nx - k);
    const Pack h = Pack::load(row.h + k), u = Pack::load(row.u + k), v = Pack::load(row.v + k);
    const Pack D = Pack::load_unaligned(&in.state.now.D[padded]);
    const Mask wet = cells & (h > 0.0);
    smallest = select(cells, min(smallest, D * (1 / s.closure.rho)), smallest);
    if (!any(wet)) continue;
    Pack speed2 = u * u + v * v, normal = s.closure.normal;
    if (s.setup.terrain) {
      const Pack w = u * Pack::load(row.bx + k) + v * Pack::load(row.by + k);
      speed2 = speed2 + w * w;
      normal = normal * Pack::load(row.c + k);
    }
    const Pack speed = sqrt(speed2), mu = law.mu(h, speed * rsqrt(max(normal * h, 1e-300)));
    largest = max(largest, select(wet, h, 0.0));
    const auto raise = [&](std::vector<double>& field, const Mask& where, const Pack& value) {
      Pack old = 0.0;
      for (int lane = 0; lane < std::min(Pack::lanes, box.nx - k); ++lane)
        old.set(lane, field[c + static_cast<std::size_t>(lane)]);
      store_where(where & (value > old), value, &field[c]);
    };
    raise(m.max_h, wet, h);
    raise(m.max_speed, wet, speed);
    raise(m.max_pressure, wet, Pack::load(row.rho + k) * speed2);
    raise(m.outside, wet & (speed > 0.0) & ((mu < mu_lo) | (mu > mu_hi)), 1.0);
    for (std::uint32_t arrived = to_integer(wet & (h > in.impact_depth)); arrived != 0; arrived &= arrived - 1) {
      double& time = m.arrival[c + static_cast<std::size_t>(std::countr_zero(arrived))];
      if (std::isnan(time)) time = in.state.time;
    }
  }
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    extremes.smallest_h = std::min(extremes.smallest_h, smallest[lane]);
    extremes.largest_h = std::max(extremes.largest_h, largest[lane]);
  }
}

}  // namespace

void observe(const ShallowInput& in, ShallowMaps& m) {
  const shallow::Solver& s = in.solver;
  const auto boxes = static_cast<std::int64_t>(s.active.size());
  std::vector<Extremes> extremes(s.active.size());
  std::visit(
      [&](const auto& friction) {
        parallel_for(
            boxes,
            [&](std::int64_t b) {
              static thread_local const auto row = std::make_unique<shallow::CellRow>();
              const auto at = static_cast<std::size_t>(b);
              const shallow::Tile& box = s.boxes[static_cast<std::size_t>(s.active[at])];
              for (int j = box.j0; j < box.j0 + box.ny; ++j)
                observe_row(in, friction.dynamic, box, j, *row, m, extremes[at]);
            },
            boxes > 1 && in.state.now.D.size() > 20000);
      },
      s.closure.friction);
  std::int64_t covered = 0;
  for (std::size_t b = 0; b < extremes.size(); ++b) {
    m.smallest_h = std::min(m.smallest_h, extremes[b].smallest_h);
    m.largest_h = std::max(m.largest_h, extremes[b].largest_h);
    const shallow::Tile& box = s.boxes[static_cast<std::size_t>(s.active[b])];
    covered += static_cast<std::int64_t>(box.nx) * box.ny;
  }
  const shallow::Grid& g = s.setup.grid;
  if (covered < static_cast<std::int64_t>(g.nx) * g.ny) m.smallest_h = std::min(m.smallest_h, 0.0);  // dry ground
}

void look(const ShallowInput& in, ShallowMaps& m) {
  const shallow::Grid& g = in.solver.setup.grid;
  std::vector<double> h, u, v;
  for (int j = 0; j < g.ny; ++j) {
    shallow::view_row(in.solver, in.state, j, h, u, v);
    const auto at = static_cast<std::ptrdiff_t>(flat(g, 0, j));
    std::copy(h.begin(), h.end(), m.h.begin() + at);
    std::copy(u.begin(), u.end(), m.u.begin() + at);
    std::copy(v.begin(), v.end(), m.v.begin() + at);
  }
}

std::vector<NamedArray> map_arrays(ShallowMaps& m) {
  return {{"maps/max_h", &m.max_h},        {"maps/max_speed", &m.max_speed}, {"maps/max_pressure", &m.max_pressure},
          {"maps/arrival", &m.arrival},    {"maps/outside", &m.outside},     {"maps/smallest_h", &m.smallest_h},
          {"maps/largest_h", &m.largest_h}};
}

std::vector<io::Column> shallow_series_columns(const ShallowInput& in) {
  std::vector<io::Column> c = {{"t", "time", "time"},
                               {"mass", "mass", "mass in the domain"},
                               {"mass_out", "mass", "mass that has left less what has entered"},
                               {"mass_error_rel", "1", "relative error of the mass balance"},
                               {"front", "length", "largest x thicker than arrival_depth"},
                               {"tail", "length", "smallest x thicker than arrival_depth"},
                               {"h_max", "length", "largest thickness"},
                               {"speed_max", "length/time", "largest speed"},
                               {"kinetic_energy", "energy", "sum of D u^2/2 over the domain"}};
  for (std::size_t k = 0; k < in.gauges.size(); ++k) {
    c.push_back({fmt::format("gauge{}_h", k), "length",
                 fmt::format("thickness at ({:g}, {:g})", in.gauges[k].x, in.gauges[k].y)});
    c.push_back({fmt::format("gauge{}_speed", k), "length/time", "speed there"});
  }
  for (std::size_t k = 0; k < in.sections.size(); ++k)
    c.push_back({fmt::format("section{}_discharge", k), "length^3/time", "volume per time to the right of the line"});
  return c;
}

std::vector<double> shallow_series_row(const ShallowInput& in, const ShallowMaps& m, double initial_mass) {
  const shallow::Grid& g = in.solver.setup.grid;
  const double mass = shallow::total_mass(in.solver, in.state), out = shallow::mass_crossed(in.solver, in.state);
  double front = nan, tail = nan, h_max = 0, fastest = 0, energy = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const std::size_t c = flat(g, i, j), p = g.at(i, j);
      if (m.h[c] > in.impact_depth) {
        front = std::isnan(front) ? g.x(i) : std::max(front, g.x(i));
        tail = std::isnan(tail) ? g.x(i) : std::min(tail, g.x(i));
      }
      const double speed = speed_of(in, p, m.u[c], m.v[c]);
      h_max = std::max(h_max, m.h[c]);
      fastest = std::max(fastest, speed);
      energy += 0.5 * in.state.now.D[p] * speed * speed * g.cell_area();
    }
  const double reference = std::max(initial_mass, mass);
  std::vector<double> row = {in.state.time, mass, out,   reference > 0 ? (mass + out - initial_mass) / reference : 0,
                             front,         tail, h_max, fastest,
                             energy};
  for (const Gauge& q : in.gauges) {
    const std::size_t c = flat(g, q.i, q.j);
    row.push_back(m.h[c]);
    row.push_back(speed_of(in, g.at(q.i, q.j), m.u[c], m.v[c]));
  }
  for (const CrossSection& line : in.sections) row.push_back(discharge(in, m, line));
  return row;
}

namespace {
// Without the halo.
std::vector<double> inner(const shallow::Grid& g, const std::vector<double>& padded) {
  std::vector<double> out(static_cast<std::size_t>(g.nx) * static_cast<std::size_t>(g.ny), 0.0);
  if (!padded.empty())
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) out[flat(g, i, j)] = padded[g.at(i, j)];
  return out;
}
std::vector<double> bed_of(const ShallowInput& in) { return inner(in.solver.setup.grid, in.solver.bed); }
io::ImageGrid image_of(const ShallowInput& in) {
  const shallow::Grid& g = in.solver.setup.grid;
  return {.origin = {g.x0, g.y0, 0}, .spacing = {g.dx, g.dy, 1}, .cells = {g.nx, g.ny, 1}, .time = in.state.time};
}
std::vector<double> mass_of(const ShallowInput& in) { return inner(in.solver.setup.grid, in.state.now.D); }
}  // namespace

void write_shallow_snapshot(io::H5File& file, const std::string& group, const ShallowInput& in, const ShallowMaps& m) {
  const shallow::Grid& g = in.solver.setup.grid;
  const io::Dims dims = {static_cast<std::size_t>(g.ny), static_cast<std::size_t>(g.nx)};
  file.write(group + "/h", m.h, dims, io::Compress::yes);
  file.write(group + "/u", m.u, dims, io::Compress::yes);
  file.write(group + "/v", m.v, dims, io::Compress::yes);
  file.write(group + "/mass", mass_of(in), dims, io::Compress::yes);
  if (g.two_d()) {
    file.write(group + "/max_h", m.max_h, dims, io::Compress::yes);
    file.write(group + "/max_speed", m.max_speed, dims, io::Compress::yes);
    file.write(group + "/arrival", m.arrival, dims, io::Compress::yes);
  }
  if (!file.exists("grid/bed")) {
    file.write("grid/bed", bed_of(in), dims, io::Compress::yes);
    const std::vector<double> corner = {g.x0, g.y0, g.dx, g.dy};
    file.write("grid/x0_y0_dx_dy", corner);
  }
}

void write_shallow_vti(const std::filesystem::path& path, const ShallowInput& in, const ShallowMaps& m) {
  const std::vector<double> bed = bed_of(in);
  std::vector<Vec3> velocity(m.h.size());
  for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] = {m.u[k], m.v[k], 0};
  io::write_vti(path, image_of(in),
                {{"thickness", std::span<const double>(m.h)},
                 {"velocity", std::span<const Vec3>(velocity)},
                 {"bed", std::span<const double>(bed)}});
}

void write_shallow_results(const std::filesystem::path& directory, const ShallowInput& in, const ShallowMaps& m) {
  const shallow::Grid& g = in.solver.setup.grid;
  const std::vector<double> bed = bed_of(in);
  if (!g.two_d()) {
    std::vector<double> x, t(m.h.size(), in.state.time);
    for (int i = 0; i < g.nx; ++i) x.push_back(g.x(i));
    io::write_csv(directory / "final.csv",
                  {{"x", "length", "centre of the cell"},
                   {"bed", "length", "elevation of the bed"},
                   {"h", "length", "thickness at the end"},
                   {"u", "length/time", "velocity at the end"},
                   {"t", "time", "time of h and u, and until when the largest values were sought"},
                   {"max_h", "length", "largest thickness"},
                   {"max_speed", "length/time", "largest speed"},
                   {"arrival", "time", "arrival"},
                   {"outside", "1", "1: closure used outside its range"}},
                  {x, bed, m.h, m.u, t, m.max_h, m.max_speed, m.arrival, m.outside}, io::CsvHeader::names_and_units);
    return;
  }
  io::write_vti(directory / "maps.vti", image_of(in),
                {{"deposit", std::span<const double>(m.h)},
                 {"max_thickness", std::span<const double>(m.max_h)},
                 {"max_speed", std::span<const double>(m.max_speed)},
                 {"max_pressure", std::span<const double>(m.max_pressure)},
                 {"arrival_time", std::span<const double>(m.arrival)},
                 {"outside_validity", std::span<const double>(m.outside)},
                 {"bed", std::span<const double>(bed)}});
  if (!in.georeferenced) return;
  const std::vector<std::pair<const char*, const std::vector<double>*>> maps = {
      {"max_thickness", &m.max_h},  {"max_speed", &m.max_speed}, {"max_pressure", &m.max_pressure},
      {"arrival_time", &m.arrival}, {"deposit", &m.h},           {"outside_validity", &m.outside}};
  for (const auto& [name, values] : maps)
    io::write_raster(directory / (std::string(name) + ".tif"), {.nx = g.nx,
                                                                .ny = g.ny,
                                                                .x0 = g.x0,
                                                                .y0 = g.y0,
                                                                .dx = g.dx,
                                                                .dy = g.dy,
                                                                .values = *values,
                                                                .projection = in.projection,
                                                                .time = in.state.time});
}

}  // namespace bagnold::app
