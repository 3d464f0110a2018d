// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/contact_problem.hpp"

#include <string>

/// Contact problems of every kind that has broken a solver, made from fixed seeds; for tests and benchmarks.
namespace flank::zoo
{
  struct Specimen
  {
    std::string name;
    ContactProblem problem;
    double torque;
    bool well_posed = true; ///< theta is unique and C far from singular
  };

  /// `lines` contact lines of slices x across cells on cylinders (radius 10 mm): the half-space's own kernel
  /// plus smooth bending that couples the lines, slightly different rigid offsets. The shape of a helical
  /// gear's problem. [mm, N] window: width of the grid over the contact's.
  Specimen contact_lines(int lines, int slices, int across, double torque, double window = 1.4);

  /// A random positive definite problem with gaps of either sign; `levers`: share of cells with lever > 0,
  /// the rest < 0 or 0.
  Specimen random(unsigned seed, int n, double levers = 1);

  /// Gaussian kernels of any width on scattered, partly coinciding points, contrast up to 1e6, gaps and
  /// levers of any sign, torques over twenty decades: what no gear has, all at once.
  Specimen hostile(unsigned seed);

  /// All named specimens.
  std::vector<Specimen> all();
} // namespace flank::zoo
