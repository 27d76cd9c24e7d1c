// Scratch rows of a tile and the kernels that fill them. Each kernel is a loop over one row without branches, so that
// it vectorises; everything that is chosen (law, geometry) is a template argument, picked once per run.
#pragma once
#include <cstdint>

#include "shallow/prepared.hpp"

namespace bagnold::shallow {

constexpr int max_tile = 124;
constexpr int row_size = max_tile + 2 * halo + 8;
using Row = double[row_size];

// What the faces need to know of the cells of one row. Entry k is cell i0 - halo + k.
struct CellRow {
  alignas(64) Row h, u, v;               // thickness, velocity; zero in dry cells
  alignas(64) Row rho, K, alpha, slope;  // closures; slope = h d(alpha)/dh of the tip
  alignas(64) Row hold;                  // mu_start(h): largest friction at rest
  alignas(64) Row rest;                  // 1: not moving (dry cells included), else 0
  alignas(64) Row gx, gy;                // slope of the surface: of K h + b less the fall of the chart
  alignas(64) Row b;                     // bed
  alignas(64) Row c, bx, by;             // terrain only: cosine of the slope, gradient of the bed
};

// Values at the two edges of each cell in one direction.
struct EdgeRow {
  alignas(64) Row h_minus, h_plus, n_minus, n_plus, t_minus, t_plus, b_minus, b_plus;
};

// Fluxes through the faces of one row; entry f lies between cell (or row) f and the next one.
struct FaceRow {
  alignas(64) Row mass, before, after, tangential;  // momentum flux as the cell before and after the face see it
  alignas(64) Row speed, locked, drop;
};

enum class Geometry { flat, bed, terrain };

// ---- closure_rows.cpp --------------------------------------------------------------------------------------------
// D, M of `n` cells -> h, u, v and closures. `row.c, bx, by` are set (terrain).
using ClosureKernel = void (*)(const PreparedClosure&, int n, const double* D, const double* Mx, const double* My,
                               CellRow&);
// One friction solve per cell, see friction_stage().
struct FrictionArgs {
  int n, stage;
  double dt;
  const double *h, *u, *v, *hold;    // the state the stage began with
  const double *c, *bx, *by, *bend;  // terrain: geometry and curvature acceleration
  const double *D_new, *Msx, *Msy;   // after fluxes and gravity
  const double *Mx_old, *My_old;     // start of the step
  double* share;                     // of the old momentum: out in stage 1, in in stage 2
  double *Mx, *My;                   // result
};
using FrictionKernel = void (*)(const PreparedClosure&, const FrictionArgs&);
struct LawKernels {
  ClosureKernel closures;
  FrictionKernel friction;
};
LawKernels choose_kernels(const closure::ClosureSet& set, bool terrain);

// ---- face_rows.cpp -----------------------------------------------------------------------------------------------
struct FaceArgs {
  int begin, end;  // faces
  const CellRow *before, *after;
  int shift;  // entry of the cell after face f is f + shift (1 in x, 0 in y)
  const EdgeRow *edge_before, *edge_after;
  double normal_g, inv_d;  // g cos(theta) (terrain: g), 1/dx
  bool along_y;            // faces between rows: gx is the tangential slope
};
template <Geometry G>
void edge_row(int begin, int end, bool second_order, const CellRow& before, const CellRow& here, const CellRow& after,
              int shift, bool along_y, EdgeRow& out);
template <Geometry G>
void drop_row(int begin, int end, const CellRow& before, const CellRow& after, int shift, const double* fall,
              FaceRow& out);
template <Geometry G>
void face_row(const FaceArgs& a, FaceRow& out);

}  // namespace bagnold::shallow
