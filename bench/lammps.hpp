// The benchmark's flow in LAMMPS, when an executable `lmp` is there: the same state, contact law and step.
#pragma once
#include <sys/resource.h>

#include <cstdlib>

#include "chute_flow.hpp"

namespace bagnold::bench {

// User and system time of this process (RUSAGE_SELF) or of its children that have ended, in seconds.
inline double cpu(int who) {
  rusage use{};
  getrusage(who, &use);
  return static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}

// What is compared: kinetic energy and centre of mass of the flowing grains (full-step velocities).
struct Sums {
  double kinetic = 0;
  Vec3 centre;
};

// `start`: the same grains a little earlier; displacements are counted through the periodic box.
inline Sums sums_of(const dem::DemState& s, const dem::DemState& start) {
  Sums sums;
  const auto n = static_cast<double>(s.grains.flowing);
  for (std::int64_t i = 0; i < s.grains.flowing; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vec3 from = wrap(start.box, start.grains.x[k]);
    sums.kinetic += 0.5 * norm2(dem::full_step_velocity(s, i));
    sums.centre += (from + minimum_image(s.box, s.grains.x[k] - from)) / n;
  }
  return sums;
}

enum class Style { granular, hooke };  // pair_style granular, gran/hooke/history

inline bool lammps_is_there() { return std::system("command -v lmp > /dev/null") == 0; }

inline void write_lammps_data(const dem::DemState& s) {
  std::ofstream data("bench-lammps.data");
  data << fmt::format(
      "chute\n\n{} atoms\n2 atom types\n0 {} xlo xhi\n0 {} ylo yhi\n-4 80 zlo zhi\n\nAtoms # sphere\n\n",
      s.grains.size(), s.box.length.x, s.box.length.y);
  const auto grains = grains_of(s);
  for (std::size_t i = 0; i < grains.size(); ++i)
    data << fmt::format("{} {} 1 {} {} {} {}\n", i + 1, grains[i].type, 6 / std::numbers::pi, grains[i].x.x,
                        grains[i].x.y, grains[i].x.z);
  data << "\nVelocities\n\n";
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const Grain& g = grains[i];
    data << fmt::format("{} {} {} {} {} {} {}\n", i + 1, g.v.x, g.v.y, g.v.z, g.omega.x, g.omega.y, g.omega.z);
  }
}

struct LammpsRun {
  double seconds = 0;
  Sums sums;
};

// Runs what write_lammps_data() left. False if it could not be run.
inline bool run_lammps(Style style, double skin, int steps, LammpsRun& out) {
  const double kt = 2 * kn / 7;
  const std::string pair =
      style == Style::granular
          ? fmt::format("granular\npair_coeff * * hooke {} {} tangential linear_history {} 1 0.5 damping velocity", kn,
                        gamma_n, kt)
          : fmt::format("gran/hooke/history {} {} {} {} 0.5 1\npair_coeff * *", kn, kt, 2 * gamma_n, 2 * gamma_n);
  std::ofstream("bench-lammps.in") << fmt::format(
      "units lj\natom_style sphere\nboundary p p f\nnewton off\ncomm_modify vel yes\nread_data bench-lammps.data\n"
      "pair_style {}\nneighbor {} bin\nneigh_modify delay 0 every 1 check yes\ngroup flow type 1\n"
      "neigh_modify exclude type 2 2\nfix g flow gravity 1 chute 24\nfix i flow nve/sphere\ntimestep 1e-4\n"
      "compute k flow ke\nvariable x equal xcm(flow,x)\nvariable y equal xcm(flow,y)\nvariable z equal xcm(flow,z)\n"
      "thermo_style custom step c_k v_x v_y v_z\nthermo_modify norm no format float %.15g\nthermo {}\nrun {}\n",
      pair, skin, steps, steps);
  const double before = cpu(RUSAGE_CHILDREN);
  if (std::system("OMP_NUM_THREADS=1 lmp -in bench-lammps.in -log bench-lammps.log > bench-lammps.out 2>&1") != 0)
    return false;
  out.seconds = cpu(RUSAGE_CHILDREN) - before;
  std::ifstream log("bench-lammps.log");
  for (std::string line; std::getline(log, line);) {
    std::istringstream words(line);
    long step = -1;
    if (words >> step && step == steps)
      words >> out.sums.kinetic >> out.sums.centre.x >> out.sums.centre.y >> out.sums.centre.z;
  }
  return true;
}

// Grain-steps per CPU second; set-up is taken out by the difference of two lengths. 0 if it could not be run.
inline double lammps_speed(const dem::DemState& s, Style style, double skin, int steps) {
  write_lammps_data(s);
  LammpsRun brief, full;
  if (!run_lammps(style, skin, 1, brief) || !run_lammps(style, skin, steps + 1, full)) return 0;
  return static_cast<double>(s.grains.flowing) * steps / (full.seconds - brief.seconds);
}

// Whether 150 steps give the same kinetic energy and centre of mass within 1e-4: the laws differ in the arm and in the
// rotation of springs by O(overlap).
inline bool lammps_agrees(const dem::DemState& start, const dem::ContactLaws& laws, Style style) {
  write_lammps_data(start);
  LammpsRun run;
  if (!run_lammps(style, 0.15, 150, run)) return false;
  dem::DemState s = start;
  prepare(s, laws);
  advance(s, laws, 150);
  const Sums own = sums_of(s, start);
  const double energy = std::abs(run.sums.kinetic / own.kinetic - 1), centre = norm(own.centre - run.sums.centre);
  fmt::print("  {}: after 150 steps the kinetic energy differs by {:.1e}, the centre of mass by {:.1e}\n",
             style == Style::hooke ? "gran/hooke/history" : "granular", energy, centre);
  return energy < 1e-4 && centre < 1e-4;
}

}  // namespace bagnold::bench
