#include "dem/state.hpp"

namespace bagnold::dem {

std::vector<NamedArray> named_arrays(DemState& s) {
  Grains& g = s.grains;
  PairList& p = s.pairs;
  WallContacts& w = s.wall_contacts;
  Ledger& l = s.ledger;
  return {{"step", &s.step},
          {"x", &g.x},
          {"v", &g.v},
          {"omega", &g.omega},
          {"force", &g.force},
          {"torque", &g.torque},
          {"diameter", &g.diameter},
          {"mass", &g.mass},
          {"inertia", &g.inertia},
          {"species", &g.species},
          {"id", &g.id},
          {"flowing", &g.flowing},
          {"pair_i", &p.i},
          {"pair_j", &p.j},
          {"pair_image", &p.image},
          {"pair_touching", &p.touching},
          {"pair_spring", &p.spring},
          {"pair_roll", &p.roll},
          {"pair_slab_begin", &p.slab_begin},
          {"pair_reference", &p.reference},
          {"pair_origin", &p.origin},
          {"wall_touching", &w.touching},
          {"wall_spring", &w.spring},
          {"wall_roll", &w.roll},
          {"skin", &s.skin},
          {"rebuilds", &s.rebuilds},
          {"next_reorder", &s.next_reorder},
          {"wrapped", &l.wrapped},
          {"damped_normal", &l.damped.normal},
          {"damped_tangential", &l.damped.tangential},
          {"damped_rolling", &l.damped.rolling},
          {"power_normal", &l.power.normal},
          {"power_tangential", &l.power.tangential},
          {"power_rolling", &l.power.rolling},
          {"sliding", &l.sliding},
          {"roll_sliding", &l.roll_sliding},
          {"opened", &l.opened}};
}

}  // namespace bagnold::dem
