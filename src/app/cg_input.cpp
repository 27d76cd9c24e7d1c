#include "app/cg_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "core/error.hpp"
#include "io/hdf5.hpp"
#include "io/lammps.hpp"
#include "io/mercury.hpp"

namespace bagnold::app {

namespace {

namespace fs = std::filesystem;
using Each = std::function<void(const cg::StoredSnapshot&)>;

// ---- own runs

cg::StoredSnapshot read_own(const io::H5File& file, const std::string& group) {
  const std::string grains = group + "/grains", list = group + "/contacts/";
  cg::StoredSnapshot s;
  s.time = file.double_attribute(group, "t");
  s.flowing = file.int_attribute(grains, "flowing");
  const auto box = file.read<double>(grains + "/box");  // origin, length, periodic (0 or 1)
  s.box = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}, {box[6] != 0, box[7] != 0, box[8] != 0}};
  s.x = file.read<Vec3>(grains + "/x");
  s.v = file.read<Vec3>(grains + "/v");
  s.omega = file.read<Vec3>(grains + "/omega");
  s.diameter = file.read<double>(grains + "/diameter");
  s.mass = file.read<double>(grains + "/mass");
  s.inertia = file.read<double>(grains + "/inertia");
  const auto i = file.read<std::int32_t>(list + "i"), j = file.read<std::int32_t>(list + "j");
  const auto branch = file.read<Vec3>(list + "branch"), force = file.read<Vec3>(list + "force");
  const auto normal = file.read<Vec3>(list + "normal");
  const auto overlap = file.read<double>(list + "overlap");
  for (std::size_t k = 0; k < i.size(); ++k)
    s.contacts.push_back(
        {.i = i[k], .j = j[k], .branch = branch[k], .normal = normal[k], .overlap = overlap[k], .force = force[k]});
  return s;
}

Vec3 read_own_run(const fs::path& path, const Each& each) {
  const auto file = io::H5File::read_only(path);
  Vec3 gravity{};
  if (!file.exists("snapshots"))
    throw InputError(fmt::format("{}: error: holds no snapshots of grains", path.string()));
  for (const std::string& name : file.children("snapshots")) {
    const std::string group = "snapshots/" + name;
    if (!file.exists(group + "/grains/box") || !file.exists(group + "/contacts"))
      throw InputError(fmt::format("{}: error: {} holds no grains and contacts, expected the run of a particle model",
                                   path.string(), group));
    const auto g = file.read<double>(group + "/grains/gravity");
    gravity = {g[0], g[1], g[2]};
    each(read_own(file, group));
  }
  return gravity;
}

// ---- foreign files

// Grains in the order of a file, and which of them do not flow.
struct Imported {
  cg::StoredSnapshot s;
  std::vector<bool> fixed;
  std::vector<std::int32_t> place;  // of a grain of the file in the snapshot

  void add(const Vec3& x, const Vec3& v, const Vec3& omega, double diameter, double mass, double inertia,
           bool is_fixed) {
    s.x.push_back(x);
    s.v.push_back(is_fixed ? Vec3{} : v);
    s.omega.push_back(is_fixed ? Vec3{} : omega);
    s.diameter.push_back(diameter);
    s.mass.push_back(mass);
    s.inertia.push_back(inertia);
    fixed.push_back(is_fixed);
  }

  // Flowing grains first, each kind in the order of the file.
  void order() {
    const std::size_t n = s.x.size();
    std::vector<std::size_t> from(n);
    for (std::size_t k = 0; k < n; ++k) from[k] = k;
    std::stable_partition(from.begin(), from.end(), [&](std::size_t k) { return !fixed[k]; });
    place.assign(n, 0);
    for (std::size_t k = 0; k < n; ++k) place[from[k]] = static_cast<std::int32_t>(k);
    const auto sort = [&](auto& values) {
      auto old = values;
      for (std::size_t k = 0; k < n; ++k) values[k] = old[from[k]];
    };
    sort(s.x);
    sort(s.v);
    sort(s.omega);
    sort(s.diameter);
    sort(s.mass);
    sort(s.inertia);
    s.flowing = std::count(fixed.begin(), fixed.end(), false);
  }

  // A contact between grains of the file (b < 0: wall); `force` acts on a, `normal` points from b to a. Pairs of the base are dropped.
  void add_contact(std::int64_t a, std::int64_t b, Vec3 normal, double overlap, Vec3 force) {
    if (b >= 0 && fixed[static_cast<std::size_t>(a)]) {
      std::swap(a, b);
      normal = -normal;
      force = -force;
    }
    if (fixed[static_cast<std::size_t>(a)]) return;
    dem::Contact c;
    c.i = place[static_cast<std::size_t>(a)];
    c.j = b < 0 ? static_cast<std::int32_t>(b) : place[static_cast<std::size_t>(b)];
    c.normal = normal;
    c.overlap = overlap;
    c.force = force;
    const double radii =
        0.5 * (s.diameter[static_cast<std::size_t>(c.i)] + (c.j < 0 ? 0 : s.diameter[static_cast<std::size_t>(c.j)]));
    c.branch = (radii - overlap) * normal;
    s.contacts.push_back(c);
  }
};

bool is_base(const ForeignOptions& o, double type) {
  return std::find(o.base_types.begin(), o.base_types.end(), std::llround(type)) != o.base_types.end();
}

double mass_of(double diameter, const ForeignOptions& o, const std::string& file) {
  if (!(o.density > 0)) throw InputError(fmt::format("{}: error: holds no masses, expected --density", file));
  return o.density * std::numbers::pi / 6 * diameter * diameter * diameter;
}

// One instant of LAMMPS.
cg::StoredSnapshot import(const io::LammpsFrame& atoms, const io::LammpsFrame& entries, const ForeignOptions& o,
                          const std::string& name) {
  const auto column = [&](const char* wanted) {
    const auto found = atoms.find(wanted);
    if (!found)
      throw InputError(fmt::format(
          "{}: error: no column {}, expected id type x y z vx vy vz radius (or diameter), and mass or --density", name,
          wanted));
    return *found;
  };
  Imported out;
  out.s.box = {atoms.lo, atoms.hi - atoms.lo, atoms.periodic};
  out.s.time = atoms.time ? *atoms.time : static_cast<double>(atoms.step) * (o.timestep > 0 ? o.timestep : 1);
  const std::size_t id = column("id"), type = column("type"), x = column("x"), y = column("y"), z = column("z"),
                    vx = column("vx"), vy = column("vy"), vz = column("vz");
  const bool by_diameter = atoms.find("diameter").has_value();
  const std::size_t size = by_diameter ? column("diameter") : column("radius");
  const auto mass = atoms.find("mass"), wx = atoms.find("omegax"), wy = atoms.find("omegay"), wz = atoms.find("omegaz");
  std::vector<std::size_t> rows(atoms.rows());  // by id: a dump need not be sorted
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = r;
  std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return atoms.at(a, id) < atoms.at(b, id); });
  std::unordered_map<std::int64_t, std::int64_t> row_of_id;
  std::vector<Vec3> position;
  for (const std::size_t r : rows) {
    const double d = atoms.at(r, size) * (by_diameter ? 1 : 2), m = mass ? atoms.at(r, *mass) : mass_of(d, o, name);
    const Vec3 omega = wx && wy && wz ? Vec3{atoms.at(r, *wx), atoms.at(r, *wy), atoms.at(r, *wz)} : Vec3{};
    row_of_id[std::llround(atoms.at(r, id))] = static_cast<std::int64_t>(position.size());
    position.push_back({atoms.at(r, x), atoms.at(r, y), atoms.at(r, z)});
    out.add(position.back(), {atoms.at(r, vx), atoms.at(r, vy), atoms.at(r, vz)}, omega, d, m, 0.1 * m * d * d,
            is_base(o, atoms.at(r, type)));
  }
  const std::vector<double> diameter = out.s.diameter;  // in the order of `position`
  out.order();
  const std::size_t skip =
      entries.columns.size() >= o.contact_columns.size() + 1 && entries.columns[0] == "index" ? 1 : 0;
  if (entries.columns.size() < o.contact_columns.size() + skip)
    throw InputError(fmt::format("{}: error: {} contact columns, expected {} ({})", name, entries.columns.size() - skip,
                                 o.contact_columns.size(), fmt::join(o.contact_columns, " ")));
  const auto value = [&](std::size_t r, const std::string& wanted) -> std::optional<double> {
    const auto it = std::find(o.contact_columns.begin(), o.contact_columns.end(), wanted);
    if (it == o.contact_columns.end()) return std::nullopt;
    return entries.at(r, skip + static_cast<std::size_t>(it - o.contact_columns.begin()));
  };
  double along = 0;
  for (std::size_t r = 0; r < entries.rows(); ++r) {
    const auto a = row_of_id.find(std::llround(value(r, "id1").value_or(-1))),
               b = row_of_id.find(std::llround(value(r, "id2").value_or(-1)));
    if (a == row_of_id.end() || b == row_of_id.end())
      throw InputError(
          fmt::format("{}: error: a contact of step {} names an atom that the atom dump lacks", name, entries.step));
    const Vec3 force{value(r, "fx").value_or(0) + value(r, "tx").value_or(0),
                     value(r, "fy").value_or(0) + value(r, "ty").value_or(0),
                     value(r, "fz").value_or(0) + value(r, "tz").value_or(0)};
    const Vec3 separation = minimum_image(
        out.s.box, position[static_cast<std::size_t>(a->second)] - position[static_cast<std::size_t>(b->second)]);
    const double distance = norm(separation), overlap = 0.5 * (diameter[static_cast<std::size_t>(a->second)] +
                                                               diameter[static_cast<std::size_t>(b->second)]) -
                                                        distance;
    if (norm2(force) == 0 && overlap <= 0) continue;  // listed as neighbours, not touching
    along += dot(force, separation) / distance;
    out.add_contact(a->second, b->second, separation / distance, overlap, force);
  }
  if (along < 0)
    throw InputError(
        fmt::format("{}: error: the contact forces of step {} attract, expected forces on id1 (swap id1 and id2 in "
                    "--contact-columns)",
                    name, entries.step));
  return out.s;
}

void read_lammps(const fs::path& atom_file, const fs::path& contact_file, const ForeignOptions& options,
                 const Each& each) {
  io::LammpsDump atoms(atom_file), contacts(contact_file);
  while (const auto frame = atoms.next()) {
    const auto entries = contacts.next();
    if (!frame->atoms || !entries || entries->atoms || entries->step != frame->step)
      throw InputError(fmt::format(
          "{}: error: does not go with {} at step {}, expected an atom dump and a local dump of the same steps",
          contact_file.string(), atom_file.string(), frame->step));
    each(import(*frame, *entries, options, atom_file.string()));
  }
}

void read_mercury(const fs::path& data_file, const ForeignOptions& options, const Each& each) {
  fs::path fstat_file = data_file;
  fstat_file.replace_extension(".fstat");
  io::MercuryData data(data_file);
  io::MercuryFstat fstat(fstat_file);
  while (const auto particles = data.next()) {
    auto contacts = fstat.next();
    while (contacts && contacts->time < particles->time * (1 - 1e-9))
      contacts = fstat.next();  // may be written more often
    if (!contacts || std::abs(contacts->time - particles->time) > 1e-9 * std::abs(particles->time))
      throw InputError(fmt::format("{}: error: holds no contacts at t = {:g}", fstat_file.string(), particles->time));
    Imported out;
    out.s.time = particles->time;
    out.s.box = {particles->lo, particles->hi - particles->lo, {true, true, false}};
    for (std::size_t i = 0; i < particles->x.size(); ++i) {
      const double d = 2 * particles->radius[i], m = mass_of(d, options, data_file.string());
      out.add(particles->x[i], particles->v[i], particles->omega[i], d, m, 0.1 * m * d * d,
              is_base(options, particles->info[i]));
    }
    out.order();
    for (const io::MercuryContact& c : contacts->contacts) {
      const auto n = static_cast<std::int64_t>(particles->x.size());
      if (c.i < 0 || c.i >= n || c.j >= n)
        throw InputError(fmt::format("{}: error: a contact at t = {:g} names a particle that {} lacks",
                                     fstat_file.string(), contacts->time, data_file.string()));
      const bool both_flow =
          c.j >= 0 && !out.fixed[static_cast<std::size_t>(c.i)] && !out.fixed[static_cast<std::size_t>(c.j)];
      if (both_flow && c.i > c.j) continue;  // the second mention of the pair
      out.add_contact(c.i, c.j, c.normal, c.overlap, c.force);
    }
    each(out.s);
  }
}

bool is_lammps(const fs::path& path) {
  std::ifstream in(path);
  std::string word;
  return static_cast<bool>(in >> word) && word == "ITEM:";
}

}  // namespace

SourceInfo read_instants(const std::vector<fs::path>& inputs, const ForeignOptions& options, const Each& each) {
  SourceInfo info;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const fs::path path = fs::is_directory(inputs[k]) ? inputs[k] / "run.h5" : inputs[k];
    if (!fs::exists(path))
      throw InputError(fmt::format(
          "{}: error: does not exist, expected a run directory, a run.h5, a LAMMPS dump or a MercuryDPM .data file",
          path.string()));
    if (path.extension() == ".h5")
      info.gravity = read_own_run(path, each);
    else if (path.extension() == ".data")
      read_mercury(path, options, each);
    else if (path.extension() == ".fstat")
      continue;  // goes with its .data
    else if (is_lammps(path)) {
      if (k + 1 >= inputs.size())
        throw InputError(
            fmt::format("{}: error: an atom dump alone holds no contacts, expected the local dump of contacts after it",
                        path.string()));
      read_lammps(path, inputs[k + 1], options, each);
      ++k;
    } else {
      throw InputError(fmt::format(
          "{}: error: is no kind of file known here, expected run.h5, a LAMMPS dump or a MercuryDPM .data file",
          path.string()));
    }
  }
  return info;
}

}  // namespace bagnold::app
