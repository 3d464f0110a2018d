// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/libraries/element_libraries.hpp"

// What the files of the module give to its door (module.cpp); each is documented where the entry of
// ElementLibraries is.

namespace flank
{
  std::unique_ptr<const ElasticBody> dealii_body(const HexMesh &mesh, const std::vector<double> &abscissas,
                                                 double youngs_modulus, double poissons_ratio);
  Condensation mumps_condense(const StiffnessMatrix &stiffness, const std::vector<char> &fixed,
                              const std::vector<int> &kept, bool keep_inside);
  Eigen::MatrixXd mumps_condense_across_ranks(const ElasticBody &body, const NodeAxes &axes,
                                              const std::vector<char> &fixed, const std::vector<int> &kept,
                                              int rank, int ranks, const SumAtRoot &add_to_root);
  void dealii_write_vtu(const std::string &path, const FieldPiece &piece);
  void dealii_write_pvtu(const std::string &path, const std::vector<FieldPiece::Array> &arrays,
                         const std::vector<std::string> &pieces);
  void dealii_write_pvd(const std::string &path, const std::vector<std::pair<double, std::string>> &files);
} // namespace flank
