#include "app/sph_input.hpp"

#include "app/time_keys.hpp"
#include "app/topics.hpp"

namespace bagnold::app {
namespace {

sph::Material read_material(const config::Section& section) {
  sph::Material m;
  m.grain_diameter = section.get<double>("grain_diameter", 0.32e-3, positive(), "m");
  m.rheology = section.read_law<laws::Rheologies>("friction", "minatti2015");
  m.yield_surface = section.read_law<laws::YieldSurfaces>("yield_surface", "drucker_prager");
  m.dilatancy = section.read_law<laws::Dilatancies>("dilatancy", "minatti2015");
  m.eos = section.read_law<laws::GrainEos>("eos", "minatti2015");
  m.regularisation = section.read_law<laws::Regularisations>("regularisation", "minatti2015");
  return m;
}

}  // namespace

SphInput read_sph(config::Case& input) {
  const config::Section root = input.root(), scene = root.child("scenario"), numerics = root.child("numerics");
  SphInput in;
  in.seed = static_cast<std::uint64_t>(root.get<std::int64_t>("seed", 1, at_least(0)));
  in.model.material = read_material(root.child("material"));
  in.model.numerics = numerics.read<sph::Numerics>();
  in.model.kernel = numerics.read_law<laws::SphKernels>("kernel", "minatti2015");
  in.model.viscous = numerics.read_law<laws::ViscousOperators>("operator", "minatti2015");
  in.model.mean = numerics.read_law<laws::ViscosityMeans>("mean", "minatti2015");
  const std::string stepping = numerics.choose("stepping", in.model.corrected() ? "implicit" : "minatti2015",
                                               {"minatti2015", "implicit", "explicit_euler"});
  in.model.stepping = stepping == "implicit"         ? sph::Stepping::implicit
                      : stepping == "explicit_euler" ? sph::Stepping::explicit_euler
                                                     : sph::Stepping::minatti2015;
  in.scenario = scene.choose("kind", std::nullopt, {"inclined_plane", "column"});
  if (in.scenario == "inclined_plane") {
    in.plane = scene.read<scenario::InclinedPlane>();
    set_geometry(in.plane, in.model);
  } else {
    in.column = scene.read<scenario::ContinuumColumn>();
    const std::string shape = scene.choose("geometry", "planar", {"planar", "axisymmetric", "cylinder"});
    in.geometry = shape == "planar"         ? scenario::ColumnGeometry::planar
                  : shape == "axisymmetric" ? scenario::ColumnGeometry::axisymmetric
                                            : scenario::ColumnGeometry::cylinder;
    set_geometry(in.column, in.geometry, in.model);
  }
  in.energy_ledger = root.child("output").get<bool>("energy_ledger", false);
  const auto time = root.child("time").read<TimeKeys>();
  in.end = time.end;
  in.stop_when_arrested = time.stop_when_arrested;
  return in;
}

void add_sph_topics(std::vector<Topic>& topics) {
  topics.push_back(topic<scenario::InclinedPlane>("scenario of model sph"));
  topics.push_back(topic<scenario::ContinuumColumn>("scenario of model sph"));
  topics.push_back(topic<sph::Numerics>("section of model sph"));
  add_registry<laws::Rheologies>(topics, "friction of the continuum (material.friction)");
  add_registry<laws::YieldSurfaces>(topics, "friction and the Lode angle (material.yield_surface)");
  add_registry<laws::Dilatancies>(topics, "volume fraction of the continuum (material.dilatancy)");
  add_registry<laws::GrainEos>(topics, "pressure of the grains (material.eos)");
  add_registry<laws::Regularisations>(topics, "viscosity at rest (material.regularisation)");
  add_registry<laws::SphKernels>(topics, "smoothing kernel (numerics.kernel)");
  add_registry<laws::ViscousOperators>(topics, "pressure and viscous forces (numerics.operator)");
  add_registry<laws::ViscosityMeans>(topics, "mean viscosity of two particles (numerics.mean)");
}

}  // namespace bagnold::app
