#include "app/dem_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/cost.hpp"
#include "core/mass_quantile.hpp"
#include "dem/contacts.hpp"
#include "dem/energy.hpp"
#include "dem/engine_name.hpp"
#include "io/hdf5.hpp"
#include "io/vtk.hpp"

namespace bagnold::app {

namespace {

struct FullStep {  // velocities at the time of the positions
  std::vector<Vec3> v, omega;
  explicit FullStep(const dem::DemState& state) {
    for (std::int64_t i = 0; i < state.grains.size(); ++i) {
      v.push_back(dem::full_step_velocity(state, i));
      omega.push_back(dem::full_step_omega(state, i));
    }
  }
};

}  // namespace

std::vector<io::Column> dem_series_columns() {
  return {{"t", "time", "time"},
          {"e_translational", "energy", "kinetic energy of translation"},
          {"e_rotational", "energy", "kinetic energy of rotation"},
          {"e_gravity", "energy", "potential energy of gravity"},
          {"e_normal_spring", "energy", "elastic energy of normal springs"},
          {"e_tangential_spring", "energy", "elastic energy of tangential springs"},
          {"e_rolling_spring", "energy", "elastic energy of rolling springs"},
          {"lost_normal_damping", "energy", "taken by normal dashpots since t = 0 (with output.energy_ledger)"},
          {"lost_tangential_damping", "energy", "taken by tangential dashpots"},
          {"lost_sliding", "energy", "taken by Coulomb sliding"},
          {"lost_rolling", "energy", "taken by rolling dashpots and sliders"},
          {"lost_opening", "energy", "left in tangential and rolling springs when contacts opened"},
          {"ledger_residual", "energy", "energy now + lost - energy at t = 0"},
          {"energy_ratio", "-", "E_kin / E_ela"},
          {"u_x", "length/time", "mean velocity of the flowing grains along x"},
          {"z_mean", "length", "height of their centre of mass"},
          {"contacts_per_grain", "-", "touching pairs, walls and base included, per flowing grain"},
          {"max_overlap_over_radius", "-", "largest overlap over the smaller radius"}};
}

std::vector<double> dem_series_row(const DemInput& in, const dem::Observation& seen, double initial_energy) {
  const dem::Energies& e = seen.energies;
  const dem::Ledger& ledger = in.state.ledger;
  const auto kept = [&](double v) { return in.state.keep_ledger ? v : NAN; };
  return {in.state.time(),
          e.translational,
          e.rotational,
          e.gravity,
          e.normal_spring,
          e.tangential_spring,
          e.rolling_spring,
          kept(ledger.damped.normal),
          kept(ledger.damped.tangential),
          kept(ledger.sliding),
          kept(ledger.damped.rolling + ledger.roll_sliding),
          kept(ledger.opened),
          kept(e.total() + dem::lost(ledger) - initial_energy),
          e.elastic() > 0 ? e.kinetic() / e.elastic() : NAN,
          seen.velocity.x,
          seen.centre_height,
          static_cast<double>(seen.contacts) / static_cast<double>(in.state.grains.flowing),
          seen.overlap_ratio};
}

void write_dem_snapshot(io::H5File& file, const std::string& group, const dem::DemState& state,
                        const std::vector<dem::Contact>& contacts) {
  const dem::Grains& g = state.grains;
  const FullStep full(state);
  const std::string grains = group + "/grains/", list = group + "/contacts/";
  file.write(grains + "id", g.id);
  file.write(grains + "x", g.x);
  file.write(grains + "v", full.v);
  file.write(grains + "omega", full.omega);
  file.write(grains + "force", g.force);
  file.write(grains + "torque", g.torque);
  file.write(grains + "diameter", g.diameter);
  file.write(grains + "mass", g.mass);
  file.write(grains + "species", g.species);
  file.write(grains + "inertia", g.inertia);
  const Box& box = state.box;
  file.write(grains + "box",
             std::vector<double>{box.origin.x, box.origin.y, box.origin.z, box.length.x, box.length.y, box.length.z,
                                 box.periodic[0] * 1.0, box.periodic[1] * 1.0, box.periodic[2] * 1.0});
  file.write(grains + "gravity", std::vector<double>{state.gravity.x, state.gravity.y, state.gravity.z});
  file.attribute(group + "/grains", "flowing", g.flowing);

  std::vector<std::int32_t> i, j;
  std::vector<Vec3> branch, normal, force, spring;
  std::vector<double> overlap;
  for (const dem::Contact& c : contacts) {
    i.push_back(c.i);
    j.push_back(c.j);
    branch.push_back(c.branch);
    normal.push_back(c.normal);
    force.push_back(c.force);
    spring.push_back(c.spring);
    overlap.push_back(c.overlap);
  }
  file.write(list + "i", i);            // rows of grains/*, not ids
  file.write(list + "j", j);            // the same, or -1 - wall
  file.write(list + "branch", branch);  // x_i - x_j, minimum image
  file.write(list + "normal", normal);  // unit vector, from j to i
  file.write(list + "force", force);    // on i
  file.write(list + "spring", spring);
  file.write(list + "overlap", overlap);
}

std::vector<std::pair<std::string, std::string>> write_dem_vtk(const std::filesystem::path& directory, int number,
                                                               const dem::DemState& state,
                                                               const std::vector<dem::Contact>& contacts) {
  const dem::Grains& g = state.grains;
  const FullStep full(state);
  std::vector<Vec3> x;
  std::vector<double> radius, speed;
  for (std::size_t i = 0; i < g.x.size(); ++i) {
    x.push_back(wrap(state.box, g.x[i]));
    radius.push_back(0.5 * g.diameter[i]);
    speed.push_back(norm(full.v[i]));
  }
  const std::string grains_name = fmt::format("grains_{:06}.vtp", number),
                    contacts_name = fmt::format("contacts_{:06}.vtp", number);
  io::write_vtp_points(directory / grains_name, x,
                       {{"id", g.id},
                        {"type", g.species},
                        {"radius", radius},
                        {"mass", g.mass},
                        {"v", full.v},
                        {"speed", speed},
                        {"omega", full.omega},
                        {"f", g.force},
                        {"tq", g.torque}});

  std::vector<std::array<Vec3, 2>> segments;
  std::vector<double> force, overlap;
  for (const dem::Contact& c : contacts) {
    const Vec3 at = wrap(state.box, g.x[static_cast<std::size_t>(c.i)]);
    segments.push_back({at, at - c.branch});
    force.push_back(norm(c.force));
    overlap.push_back(c.overlap);
  }
  io::write_vtp_lines(directory / contacts_name, segments, {{"force", force}, {"overlap", overlap}});
  return {{"grains", grains_name}, {"contacts", contacts_name}};
}

namespace {

// Front and height of a spreading column: the radii that hold 50, 90 and 99 % of the mass, and the top of the pile.
void add_column(nlohmann::ordered_json& summary, const DemInput& in) {
  const dem::Grains& g = in.state.grains;
  std::vector<std::pair<double, double>> by_radius;
  double top = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(g.flowing); ++i) {
    by_radius.emplace_back(std::hypot(g.x[i].x, g.x[i].y), g.mass[i]);
    top = std::max(top, g.x[i].z + 0.5 * g.diameter[i]);
  }
  const MassQuantiles radius(std::move(by_radius));
  const double r0 = in.column_radius, front = radius.at(0.99);
  nlohmann::ordered_json column;
  if (in.scenario == "column") column["aspect_ratio"] = in.column_height / r0;
  column["r0"] = r0;
  column["r_final"] = front;
  column["runout"] = front / r0 - 1;
  column["runout_90"] = radius.at(0.9) / r0 - 1;
  column["runout_50"] = radius.at(0.5) / r0 - 1;
  column["height_final"] = top;
  column["slope_deg"] = std::atan2(top, front) * 180 / M_PI;
  summary[in.scenario] = column;
}

// Where a pile has got to: x below which 1, 50 and 99 % of the mass lie.
void add_avalanche(nlohmann::ordered_json& summary, const DemInput& in) {
  const dem::Grains& g = in.state.grains;
  std::vector<std::pair<double, double>> by_x;
  for (std::size_t i = 0; i < static_cast<std::size_t>(g.flowing); ++i)
    by_x.emplace_back(wrap(in.state.box, g.x[i]).x, g.mass[i]);
  const MassQuantiles x(std::move(by_x));
  summary["avalanche"] = {{"tail", x.at(0.01)}, {"middle", x.at(0.5)}, {"front", x.at(0.99)}};
}

}  // namespace

void add_dem_summary(nlohmann::ordered_json& summary, const DemInput& in, const dem::Observation& seen,
                     double initial_energy) {
  const dem::Energies& e = seen.energies;
  nlohmann::ordered_json energy;
  energy["kinetic"] = e.kinetic();
  energy["elastic"] = e.elastic();
  energy["gravity"] = e.gravity;
  energy["ratio"] = e.elastic() > 0 ? e.kinetic() / e.elastic() : NAN;
  energy["ledger_residual"] = in.state.keep_ledger ? e.total() + dem::lost(in.state.ledger) - initial_energy : NAN;
  summary["energy"] = energy;
  summary["max_overlap_over_radius"] = seen.overlap_ratio;
  if (in.scenario == "column" || in.scenario == "heap") add_column(summary, in);
  if (in.scenario == "avalanche") add_avalanche(summary, in);
}

std::vector<Derived> dem_derived(const DemInput& in) {
  std::vector<Derived> out;
  const auto number = [](double v) { return fmt::format("{:.6g}", v); };
  for (const dem::ContactType& type : dem::contact_types(in.state, in.model)) {
    const std::string pair = type.a + "-" + type.b;
    out.push_back({"contact " + pair, fmt::format("m_ij = {:.6g}", type.reduced_mass),
                   "reduced mass at which the following hold"});
    out.push_back({"  collision time tc", number(type.tc), "eq. 5"});
    out.push_back({"  restitution", number(type.restitution), "eq. 6"});
    out.push_back(
        {"  kn, gamma_n", fmt::format("{:.6g}, {:.6g}", type.kn, type.gamma_n), "f_n = kn delta - gamma_n v_n"});
    out.push_back(
        {"  kt, gamma_t, mu", fmt::format("{:.6g}, {:.6g}, {:.6g}", type.kt, type.gamma_t, type.mu), "tangential"});
  }
  const dem::Grains& g = in.state.grains;
  const dem::StepLimit& limit = in.limit;
  out.push_back({"time step", number(in.state.dt),
                 limit.by_dashpots() ? fmt::format("{:.3g} of the largest stable step of {}",
                                                   in.state.dt / limit.stable, to_string(limit))
                                     : fmt::format("tc/{:.4g} of {}", limit.tc / in.state.dt, to_string(limit))});
  out.push_back({"steps", fmt::format("{:.0f}", std::ceil(in.end / in.state.dt - 1e-6)), ""});
  const std::int64_t fixed = g.size() - g.flowing;
  if (in.unsettled.empty()) {
    out.push_back({"grains", fmt::format("{} + {} fixed", g.flowing, fixed), "flowing + base"});
    if (!in.beds.empty()) out.push_back({"bed", in.bed_hash.substr(0, 16), "its hash begins so"});
    return out;
  }
  const std::string flowing = in.scenario == "avalanche" || in.scenario == "column" ? "about " : "";
  out.push_back({"grains", fmt::format("{}{} + about {} fixed", flowing, g.flowing, fixed),
                 "flowing + base; estimated, for the bed is not settled yet"});
  for (const scenario::BedRecipe& recipe : in.unsettled)
    out.push_back({"bed", fmt::format("{} grains", scenario::bed_grains(recipe)),
                   "not settled yet; the first time " + time_text(bed_cost(recipe), "bed")});
  return out;
}

// By memory, a grain and a listed pair; by file, the arrays of a snapshot, of its ParaView files and of a checkpoint.
Cost dem_cost(const DemInput& in) {
  const auto size = static_cast<double>(in.state.grains.size()), flowing = static_cast<double>(in.state.grains.flowing);
  const double contacts = 2.2 * flowing;
  return {.elements = "grain",
          .engine = std::string(dem::engine_name(in.state)),
          .count = flowing,
          .element_steps = std::ceil(in.end / in.state.dt - 1e-6) * flowing,
          .usual_speed = dem::engine_name(in.state) == "fast" ? 2e7 : 4e6,
          .memory_mb = size * 600e-6,
          .snapshot_mb = (size * 192 + contacts * 136) * 1e-6,
          .vtk_mb = (size * 210 + contacts * 120) * 1e-6,
          .checkpoint_mb = (size * 230 + contacts * 70) * 1e-6,
          .estimated = !in.unsettled.empty()};
}

}  // namespace bagnold::app
