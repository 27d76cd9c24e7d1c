// The continuum model as the driver sees it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/model.hpp"
#include "app/signals.hpp"
#include "app/sph_input.hpp"
#include "core/constants.hpp"
#include "io/csv.hpp"
#include "io/hdf5.hpp"
#include "io/vtk.hpp"
#include "scenario/printed_flow.hpp"
#include "sph/constitutive.hpp"
#include "sph/energy.hpp"
#include "sph/interpolate.hpp"
#include "sph/observe.hpp"

namespace bagnold::app {
namespace {

constexpr double steady_rate = 1e-3;    // relative change of the mean velocity in a second below which a flow is steady
constexpr double steady_window = 0.25;  // s, over which it is taken, whatever is written when
constexpr double rest_speed = 1e-3;     // root mean square over sqrt(g H0) below which a column has arrested ...
constexpr double rest_after = 2;        // ... later than this many sqrt(H0/g)
constexpr std::int64_t rest_every = 64;  // steps between looks

class SphModel final : public Model {
 public:
  explicit SphModel(SphInput input) : in_(std::move(input)) {}

  void build(const Building&) override {
    state_.particles = on_plane() ? make_particles(in_.plane, in_.model)
                                  : make_particles(in_.column, in_.geometry, in_.model, in_.seed);
    initialise(state_, work_, in_.model);
    state_.keep_ledger = in_.energy_ledger;
  }

  std::string_view scenario() const override { return in_.scenario; }
  double time() const override { return state_.time; }
  double end_time() const override { return in_.end; }
  std::int64_t step() const override { return state_.step; }
  double element_steps() const override { return particle_steps_; }

  void advance(double until) override {
    while (state_.time < until && !ended() && !stop_requested()) {
      sph::step(state_, work_, in_.model, in_.end);
      particle_steps_ += static_cast<double>(state_.particles.size());
      if (on_plane())
        watch_steadiness();
      else if (state_.step % rest_every == 0)
        watch_arrest();
    }
  }
  bool ended() const override { return in_.stop_when_arrested && arrested_ != 0; }
  std::string status() const override { return arrested_ != 0 ? "arrested" : "completed"; }

  std::vector<NamedArray> state() override {
    auto arrays = named_arrays(state_);
    for (NamedArray& a : arrays) a.name = "sph/" + a.name;
    arrays.push_back({"mean_velocity", &last_mean_});
    arrays.push_back({"mean_velocity_time", &last_time_});
    arrays.push_back({"steady_time", &steady_time_});
    arrays.push_back({"max_inertial_number", &max_i_});
    arrays.push_back({"arrested", &arrested_});
    return arrays;
  }
  void restored() override { restore(state_, work_, in_.model); }

  std::vector<io::Column> series_columns() const override {
    std::vector<io::Column> columns{{"t", "s", "time"}, {"dt", "s", "step"}};
    const auto add = [&](std::initializer_list<io::Column> more) { columns.insert(columns.end(), more); };
    if (on_plane())
      add({{"kinetic_energy", "J/m", "sum m v^2/2"},
           {"u_mean", "m/s", "mean velocity down the slope"},
           {"u_max", "m/s", "fastest particle"},
           {"max_inertial_number", "", "largest i inside the flow so far"}});
    else
      add({{"kinetic_energy", "J", "sum m v^2/2 (J/m planar)"},
           {"front", "m", "reach of the connected material"},
           {"front_raw", "m", "reach of the farthest particle"},
           {"front_layer", "m", "reach of the layer at least a grain, and half a particle, deep"},
           {"height", "m", "of the connected material"},
           {"speed_rms", "m/s", "root mean square, by mass: the creep of a deposit"},
           {"max_inertial_number", "", "largest i inside the flow so far"}});
    if (state_.keep_ledger)
      for (const LedgerEntry& e : ledger()) columns.push_back({e.name, on_plane() ? "J/m" : "J", e.meaning});
    return columns;
  }
  std::vector<double> series_row() override {
    refresh(state_, work_, in_.model);
    max_i_ = std::max(max_i_, max_inertial_number(state_, work_, in_.model));
    const double energy = kinetic_energy(state_, in_.model);
    std::vector<double> row{state_.time, state_.dt, energy};
    if (on_plane()) {
      const auto& u = state_.particles.v[0];
      row.insert(row.end(), {mean_velocity(), *std::max_element(u.begin(), u.end()), max_i_});
    } else {
      const sph::Front front = find_front(state_, work_, in_.model);
      row.insert(row.end(), {front.connected, front.raw, front.layer, front.height, rms_speed(energy), max_i_});
    }
    if (state_.keep_ledger)
      for (const LedgerEntry& e : ledger()) row.push_back(e.value);
    return row;
  }

  std::string progress() override {
    if (on_plane()) return fmt::format("u {:.3g} m/s", mean_velocity());
    const sph::Front front = find_front(state_, work_, in_.model);
    return fmt::format("(r - r0)/r0 {:.3f}", front.connected / in_.column.radius - 1);
  }

  void write_snapshot(io::H5File& file, const std::string& group) override {
    const Points p = points();
    file.write(group + "/x", p.x);
    file.write(group + "/v", p.v);
    file.write(group + "/rho", state_.particles.rho);
    file.write(group + "/p", work_.pressure);
    file.write(group + "/eta", work_.viscosity);
    file.write(group + "/id", state_.particles.id);
    file.attribute(group, "t", state_.time);
    file.attribute(group, "spacing", in_.model.spacing);
  }

  std::vector<std::pair<std::string, std::string>> write_vtk(const std::filesystem::path& directory,
                                                             int number) override {
    const Points p = points();
    const std::string particles = fmt::format("particles_{:05d}.vtp", number);
    io::write_vtp_points(directory / particles, p.x,
                         {{"id", std::span<const std::int64_t>(state_.particles.id)},
                          {"v", std::span<const Vec3>(p.v)},
                          {"speed", std::span<const double>(p.speed)},
                          {"p", std::span<const double>(work_.pressure)},
                          {"rho", std::span<const double>(state_.particles.rho)},
                          {"i", std::span<const double>(p.i)},
                          {"eta", std::span<const double>(work_.viscosity)}});
    const std::string fields = fmt::format("fields_{:05d}.vti", number);
    write_fields(directory / fields);
    return {{"particles", particles}, {"fields", fields}};
  }

  void write_results(const std::filesystem::path& directory) override {
    if (!on_plane()) return;
    refresh(state_, work_, in_.model);
    const auto flow = steady_flow(in_.plane, in_.model);
    const auto rows = static_cast<std::size_t>(std::max(1L, std::lround(in_.plane.height / in_.plane.spacing)));
    std::vector<std::vector<double>> cells(7, std::vector<double>(rows, NAN));
    cells.back().assign(rows, state_.time);
    std::vector<double> count(rows, 0.0), z(rows, 0.0), u(rows, 0.0), p(rows, 0.0), rho(rows, 0.0);
    const sph::Particles& q = state_.particles;
    for (std::size_t i = 0; i < q.mass.size(); ++i) {
      const auto row =
          std::min(rows - 1, static_cast<std::size_t>(q.x[1][i] / in_.plane.height * static_cast<double>(rows)));
      count[row] += 1, z[row] += q.x[1][i], u[row] += q.v[0][i], p[row] += work_.pressure[i], rho[row] += q.rho[i];
    }
    for (std::size_t r = 0; r < rows; ++r) {
      if (count[r] == 0) continue;
      const double height = z[r] / count[r];
      const double values[] = {height,
                               u[r] / count[r],
                               flow.velocity(height),
                               p[r] / count[r],
                               flow.pressure(height, in_.model.grains().grain_density),
                               rho[r] / count[r]};
      for (std::size_t c = 0; c < std::size(values); ++c) cells[c][r] = values[c];
    }
    io::write_csv(directory / "profile.csv",
                  {{"z", "m", "height over the base"},
                   {"u_x", "m/s", "velocity down the slope"},
                   {"u_x_exact", "m/s", "eq. 56"},
                   {"p", "Pa", "pressure"},
                   {"p_exact", "Pa", "hydrostatic"},
                   {"rho", "kg/m^3", "bulk density"},
                   {"t", "s", "time of the profile"}},
                  cells, io::CsvHeader::names_and_units);
  }

  void add_summary(nlohmann::ordered_json& summary, double wall_s) override {
    refresh(state_, work_, in_.model);
    const double max_i = std::max(max_i_, max_inertial_number(state_, work_, in_.model));
    summary["particles"] = state_.particles.size();
    summary["particle_steps_per_s"] = wall_s > 0 ? particle_steps_ / wall_s : NAN;
    summary["force_evaluations"] = state_.force_evaluations;
    summary["max_inertial_number"] = max_i;
    if (state_.keep_ledger) {
      auto& energy = summary["energy"];
      energy["kinetic_energy"] = kinetic_energy(state_, in_.model);
      for (const LedgerEntry& e : ledger()) energy[e.name] = e.value;
    }
    if (on_plane()) {
      const auto flow = steady_flow(in_.plane, in_.model);
      constexpr int cells = 200;  // of the one-dimensional transient
      const auto transient = transient_flow(in_.plane, in_.model, in_.plane.height, cells, {state_.time}).front();
      double error = 0, scale = 0, top = 0, surface = 0, p_error = 0, p_scale = 0, t_error = 0, t_scale = 0;
      const sph::Particles& p = state_.particles;
      for (std::size_t i = 0; i < p.mass.size(); ++i) {
        const double z = p.x[1][i], u = flow.velocity(z), exact = flow.pressure(z, in_.model.grains().grain_density);
        const double then = transient[static_cast<std::size_t>(std::clamp(z / in_.plane.height, 0.0, 0.999) * cells)];
        t_error += (p.v[0][i] - then) * (p.v[0][i] - then), t_scale += then * then;
        error += (p.v[0][i] - u) * (p.v[0][i] - u), scale += u * u;
        p_error += (work_.pressure[i] - exact) * (work_.pressure[i] - exact), p_scale += exact * exact;
        if (z > in_.plane.height - 1.5 * in_.plane.spacing) surface += p.v[0][i], top += 1;
      }
      summary["profile_error_l2"] = scale > 0 ? std::sqrt(error / scale) : NAN;
      summary["transient_error_l2"] = t_scale > 0 ? std::sqrt(t_error / t_scale) : NAN;
      summary["pressure_error_l2"] = std::sqrt(p_error / p_scale);
      summary["u_surface"] = top > 0 ? surface / top : NAN;
      summary["u_surface_exact"] = flow.u_surface;
      summary["steady_time"] = steady_time_ > 0 ? steady_time_ : NAN;
      summary["u_mean"] = mean_velocity();
      if (!in_.model.corrected() && std::holds_alternative<laws::rheology::MuI>(in_.model.material.rheology)) {
        const auto response = printed_response(in_.plane, state_, work_, in_.model);
        summary["stress_response"] = response.stress;
        summary["gradient_response"] = response.gradient;
        summary["u_mean_responding"] = responding_velocity(in_.plane, in_.model, response, state_.time);
      }
      return;
    }
    const sph::Front front = find_front(state_, work_, in_.model);
    const double aspect = in_.column.height / in_.column.radius;
    summary["aspect_ratio"] = aspect;
    summary["r0"] = in_.column.radius;
    summary["r_final"] = front.connected;
    summary["r_final_raw"] = front.raw;
    summary["r_final_layer"] = front.layer;
    summary["runout"] = front.connected / in_.column.radius - 1;
    summary["runout_layer"] = front.layer / in_.column.radius - 1;
    const MassQuantiles radius = sph::radii(state_, in_.model);
    summary["runout_90"] = radius.at(0.9) / in_.column.radius - 1;
    summary["runout_50"] = radius.at(0.5) / in_.column.radius - 1;
    summary["runout_experiment"] = scenario::measured_runout(aspect, in_.geometry);
    summary["height_final"] = front.height;
    summary["speed_rms"] = rms_speed(kinetic_energy(state_, in_.model));
  }

  std::vector<Derived> derived() override {
    const sph::Model& m = in_.model;
    return {
        {"particles", fmt::format("{}", state_.particles.size()), "number of particles"},
        {"smoothing length", fmt::format("{:.4g} m", m.h()), "h"},
        {"sound speed", fmt::format("{:.4g} m/s", m.sound_speed()), "c = 1/sqrt(Kt phi_max rho_s0)"},
        {"Mach number",
         fmt::format("{:.3g}",
                     std::sqrt(earth_gravity * (on_plane() ? in_.plane.height : in_.column.height)) / m.sound_speed()),
         "sqrt(g H)/c; 0.1 or less keeps compression small"},
        {"largest viscosity over density", fmt::format("{:.4g} m^2/s", state_.max_kinematic_viscosity), "at the start"},
        {"largest step", fmt::format("{:.3g} s", step_limit(state_, m)), "eq. 39; sound only when implicit"}};
  }

  // A step has about 1.4 kB of memory a particle; what is written, the arrays of particles and their grid.
  Cost cost() override {
    const auto count = static_cast<double>(state_.particles.size());
    return {.elements = "particle",
            .engine = in_.model.stepping == sph::Stepping::implicit ? "implicit" : "explicit",
            .count = count,
            .element_steps = count * std::ceil(in_.end / step_limit(state_, in_.model)),
            .usual_speed = 1e6,
            .memory_mb = count * 1800e-6,
            .snapshot_mb = count * 80e-6,
            .vtk_mb = count * 360e-6,
            .checkpoint_mb = count * 150e-6};
  }

 private:
  struct Points {
    std::vector<Vec3> x, v;
    std::vector<double> speed, i;
  };
  struct LedgerEntry {
    const char* name;
    double value;
    const char* meaning;
  };
  std::vector<LedgerEntry> ledger() const {
    const sph::Ledger& l = state_.ledger;
    return {
        {"potential_energy", potential_energy(state_, in_.model), "-sum m g.x"},
        {"elastic_energy", elastic_energy(state_, in_.model), "of squeezed grains"},
        {"gravity_work", l.gravity, "done by gravity since t = 0"},
        {"pressure_work", l.pressure, "done against pressure: squeezes grains, dilates"},
        {"lost_friction", l.friction, "to the viscosity of the law"},
        {"lost_bulk", l.bulk, "to bulk viscosity"},
        {"lost_residual", l.residual, "to residual viscosity; printed operator: to its stress less that of the law"},
        {"lost_artificial", l.artificial, "to artificial viscosity"},
        {"lost_stepping", l.stepping, "to the finite step"},
        {"lost_walls", l.walls, "to base friction and being put back"},
        {"displaced", l.displaced, "potential energy gained by shifting and being put back"},
        {"diffusion_work", l.diffusion, "of density diffusion and volume correction, in compression"},
        {"ledger_residual", ledger_residual(state_, in_.model), "gravity_work - pressure_work - lost - kinetic"}};
  }
  bool on_plane() const { return in_.scenario == "inclined_plane"; }
  double mean_velocity() const { return momentum(state_, in_.model)[0] / total_mass(state_); }
  void watch_steadiness() {
    if (state_.time < last_time_ + steady_window) return;
    const double mean = mean_velocity(), elapsed = state_.time - last_time_;
    if (steady_time_ == 0 && mean > 0 && std::abs(mean - last_mean_) < steady_rate * mean * elapsed)
      steady_time_ = state_.time;
    last_mean_ = mean;
    last_time_ = state_.time;
  }
  void watch_arrest() {
    const double g = earth_gravity, H = in_.column.height;
    arrested_ = state_.time > rest_after * std::sqrt(H / g) &&
                rms_speed(kinetic_energy(state_, in_.model)) < rest_speed * std::sqrt(g * H);
  }
  double rms_speed(double energy) const { return std::sqrt(2 * energy / total_mass(state_)); }
  // Fresh fields and three-dimensional positions; an infinite inertial number (no pressure) is written as NaN.
  Points points() {
    refresh(state_, work_, in_.model);
    const sph::Particles& p = state_.particles;
    Points out;
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      const auto vector = [&](const sph::Field& f) {
        return in_.model.dim == 2 ? Vec3{f[0][i], 0, f[1][i]} : Vec3{f[0][i], f[1][i], f[2][i]};
      };
      out.x.push_back(vector(p.x));
      out.v.push_back(vector(p.v));
      out.speed.push_back(norm(out.v.back()));
      const double number = inertial_number(in_.model, work_.shear_rate[i], p.root[i]);
      out.i.push_back(std::isfinite(number) ? number : NAN);
    }
    return out;
  }

  // The same quantities on a grid; empty cells hold NaN.
  void write_fields(const std::filesystem::path& path) const {
    const sph::GridFields g = interpolate(state_, work_, in_.model);
    std::vector<Vec3> v(g.speed.size());
    for (std::size_t c = 0; c < v.size(); ++c)
      v[c] = in_.model.dim == 2 ? Vec3{g.velocity[0][c], 0, g.velocity[1][c]}
                                : Vec3{g.velocity[0][c], g.velocity[1][c], g.velocity[2][c]};
    io::write_vti(path,
                  {.origin = {g.origin[0], g.origin[1], g.origin[2]},
                   .spacing = {g.spacing, g.spacing, g.spacing},
                   .cells = g.cells,
                   .time = state_.time},
                  {{"filled", std::span<const double>(g.filled)},
                   {"v", std::span<const Vec3>(v)},
                   {"speed", std::span<const double>(g.speed)},
                   {"p", std::span<const double>(g.pressure)},
                   {"rho", std::span<const double>(g.density)},
                   {"i", std::span<const double>(g.inertial_number)},
                   {"eta", std::span<const double>(g.viscosity)}});
  }

  SphInput in_;
  sph::State state_;
  sph::Work work_;
  double particle_steps_ = 0;
  double last_mean_ = 0, last_time_ = 0, steady_time_ = 0, max_i_ = 0;
  std::int64_t arrested_ = 0;
};

}  // namespace

std::unique_ptr<Model> make_sph(config::Case& input) { return std::make_unique<SphModel>(read_sph(input)); }

}  // namespace bagnold::app
