// Scratch rows of a tile and the kernels that fill them, eight numbers at a time. Everything that is chosen (law,
// geometry) is a template argument, picked once per run. Kernels may compute a few entries beyond those asked for.
#pragma once
#include <cstdint>

#include "core/simd.hpp"
#include "shallow/prepared.hpp"

namespace bagnold::shallow {

constexpr int max_tile = 124;
constexpr int row_size = max_tile + 4 * reach + 2 * Pack::lanes;  // stage 1 computes what stage 2 looks at
using Row = double[row_size];

// What the faces need to know of the cells of one row. Entry k is cell i0 - reach + k of
// a stage over the cells from i0 on.
struct CellRow {
  alignas(64) double lead[Pack::lanes];  // kernels read one entry before a row
  alignas(64) Row h, u, v, speed;        // thickness, velocity and its size; zero in dry cells
  alignas(64) Row rho, K, alpha, slope;  // closures; slope = h d(alpha)/dh of the tip
  alignas(64) Row hold;                  // mu_start(h): largest friction at rest
  alignas(64) Row drop;                  // rise of the surface to the next cell of the row, see drop_row()
  alignas(64) Row gx, gy;                // slope of the surface: of K h + b less the fall of the chart
  alignas(64) Row b;                     // bed
  alignas(64) Row c, bx, by;             // terrain only: cosine of the slope, gradient of the bed
  bool any_rest;  // of cells, dry ones included; drop, gx, gy are there only if something rests, or on terrain
};

// Half the limited difference over each cell in one direction: a value at an edge is that of the cell -+ this.
struct SlopeRow {
  alignas(64) Row h, u, v, b;
};

// Fluxes through the faces of one row; entry f lies between cell (or row) f and the next one.
struct FaceRow {
  alignas(64) Row mass, tangential;
  alignas(64) Row before, after;  // momentum as the cell before and after the face see it; without bed only `before`
  alignas(64) Row speed, drop;
  alignas(64) Row locked;  // only if a cell beside the row rests
};

// Where the chain of operations on a pack is long and the processor looks ahead over less than two of them, two packs go
// abreast: f(k) computes, put(k, result) stores. Rows reach two packs beyond n.
template <class F, class Put>
[[gnu::always_inline]] inline void abreast(int n, F&& f, Put&& put) {
  for (int k = 0; k < n; k += 2 * Pack::lanes) {
    const auto one = f(k), other = f(k + Pack::lanes);
    put(k, one);
    put(k + Pack::lanes, other);
  }
}

enum class Geometry { flat, bed, terrain };

// ---- closure_rows.cpp --------------------------------------------------------------------------------------------
// D, M of `n` cells -> h, u, v and closures. `row.c, bx, by` are set (terrain). May read eight entries beyond n.
using ClosureKernel = void (*)(const PreparedClosure&, int n, const double* D, const double* Mx, const double* My,
                               CellRow&);
// One friction solve per cell, see friction_stage().
struct FrictionArgs {
  int begin, end, stage;  // entries; all rows start at entry 0
  double dt;
  const double *h, *speed, *hold;    // the state the stage began with
  const double *c, *bx, *by, *bend;  // terrain: geometry and curvature acceleration
  const double *D_new, *Msx, *Msy;   // after fluxes and gravity
  const double *Mx_old, *My_old;     // start of the step
  double* share;                     // of the old momentum: out in stage 1, in in stage 2
  double *D, *Mx, *My;               // result
};
using FrictionKernel = void (*)(const PreparedClosure&, const FrictionArgs&);
struct LawKernels {
  ClosureKernel closures;
  FrictionKernel friction;
};
LawKernels choose_kernels(const closure::ClosureSet& set, bool terrain);

// ---- face_rows.cpp -----------------------------------------------------------------------------------------------
struct FaceArgs {
  int end;  // faces
  const CellRow *before, *after;
  int shift;  // entry of the cell after face f is f + shift (1 in x, 0 in y)
  const SlopeRow *slope_before, *slope_after;
  const double* drop;
  double normal_g, inv_d;  // g cos(theta) (terrain: g), 1/dx
  bool along_y;            // faces between rows: gx is the tangential slope
};
template <Geometry G>
void slope_row(int end, bool second_order, const CellRow& before, const CellRow& here, const CellRow& after, int shift,
               SlopeRow& out);
template <Geometry G>
void drop_row(int end, const CellRow& before, const CellRow& after, int shift, const double* fall, double* drop);
template <Geometry G>
void face_row(const FaceArgs& a, FaceRow& out);

}  // namespace bagnold::shallow
