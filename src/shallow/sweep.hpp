// One Runge-Kutta stage over a box of cells, swept row by row with a few rows of scratch.
#pragma once
#include "shallow/solver.hpp"

namespace bagnold::shallow {

struct Scratch {
  CellRow cells[4];
  SlopeRow x_slopes, y_slopes[2];
  FaceRow x_faces, y_faces[2];
  bool still_rows = false;  // y_faces and y_slopes are those of one dimension
  alignas(64) Row D_new, Msx, Msy, bend, fall;
  Conserved predicted;  // by stage 1, over a tile
  Conserved kept;       // of stage 1 for stage 2: D: share of the old momentum that friction takes; M: rates of change
};

// What a stage works on.
struct Stage {
  int number;
  double dt;
  Tile cells, own;          // to be computed; among them those of the tile
  ConstWindow start, from;  // the step began with; the stage begins with
  Window to, kept;
};

template <Geometry G>
StageResult sweep(Solver& solver, const Stage& stage, Scratch& scratch);

}  // namespace bagnold::shallow
