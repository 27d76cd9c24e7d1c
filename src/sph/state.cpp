#include "sph/state.hpp"

namespace bagnold::sph {

std::vector<NamedArray> named_arrays(State& state) {
  Particles& p = state.particles;
  std::vector<NamedArray> arrays{{"time", &state.time}, {"dt", &state.dt},
                                 {"step", &state.step}, {"max_kinematic_viscosity", &state.max_kinematic_viscosity},
                                 {"rho", &p.rho},       {"mass", &p.mass},
                                 {"root", &p.root},     {"id", &p.id},
                                 {"skin", &p.skin},     {"force_evaluations", &state.force_evaluations}};
  const std::array<std::pair<const char*, Field*>, 4> vectors{
      {{"x", &p.x}, {"v", &p.v}, {"rate", &p.rate}, {"x_built", &p.x_built}}};
  Ledger& l = state.ledger;
  const std::array<std::pair<const char*, double*>, 11> entries{{{"start", &l.start},
                                                                 {"gravity", &l.gravity},
                                                                 {"pressure", &l.pressure},
                                                                 {"friction", &l.friction},
                                                                 {"bulk", &l.bulk},
                                                                 {"residual", &l.residual},
                                                                 {"artificial", &l.artificial},
                                                                 {"stepping", &l.stepping},
                                                                 {"walls", &l.walls},
                                                                 {"displaced", &l.displaced},
                                                                 {"diffusion", &l.diffusion}}};
  for (const auto& [name, value] : entries) arrays.push_back({std::string("ledger/") + name, value});
  for (const auto& [name, vector] : vectors)
    for (std::size_t k = 0; k < 3; ++k) arrays.push_back({std::string(name) + "_" + std::to_string(k), &(*vector)[k]});
  return arrays;
}

Particles make_particles(std::int64_t count, int dim) {
  const auto n = static_cast<std::size_t>(count);
  Particles p;
  for (Field* f : {&p.x, &p.v, &p.rate, &p.x_built})
    for (int k = 0; k < dim; ++k) (*f)[static_cast<std::size_t>(k)].assign(n, 0.0);
  for (auto* a : {&p.rho, &p.mass, &p.root}) a->assign(n, 0.0);
  p.id.resize(n);
  for (std::size_t i = 0; i < n; ++i) p.id[i] = static_cast<std::int64_t>(i);
  return p;
}

}  // namespace bagnold::sph
