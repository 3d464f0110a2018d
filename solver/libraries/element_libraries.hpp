// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/elastic_body.hpp"
#include "solver/libraries/vtu_file.hpp"
#include "solver/linear/direct_solver.hpp"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace flank
{
  using SumAtRoot =
      std::function<void(double *values, std::ptrdiff_t count)>; ///< as ParallelSession::add_to_root()

  /// What deal.II, PETSc and MUMPS do. They and the 200 libraries they need are in a module of their own that
  /// is loaded when something first needs it, because loading takes longer (0.2 to 0.3 s) than much of what
  /// runs from cached operators. Each entry is documented where the function of its name is declared.
  struct ElementLibraries
  {
    std::unique_ptr<const ElasticBody> (*elastic_body)(const HexMesh &mesh,
                                                       const std::vector<double> &abscissas,
                                                       double youngs_modulus, double poissons_ratio);
    Condensation (*condense)(const StiffnessMatrix &stiffness, const std::vector<char> &fixed,
                             const std::vector<int> &kept, bool keep_inside);
    Eigen::MatrixXd (*condense_across_ranks)(const ElasticBody &body, const NodeAxes &axes,
                                             const std::vector<char> &fixed, const std::vector<int> &kept,
                                             int rank, int ranks, const SumAtRoot &add_to_root);
    void (*write_vtu)(const std::string &path, const FieldPiece &piece);
    void (*write_pvtu)(const std::string &path, const std::vector<FieldPiece::Array> &arrays,
                       const std::vector<std::string> &pieces);
    void (*write_pvd)(const std::string &path, const std::vector<std::pair<double, std::string>> &files);
    void (*finish)(); ///< to be called before MPI ends
  };

  /// The entries of the libraries, which the first call loads (MPI runs by then). Throws LibraryError
  /// where the module is not beside the program.
  const ElementLibraries &element_libraries();

  /// To be called before MPI ends: lets the libraries finish, if they were loaded at all.
  void finish_element_libraries();
} // namespace flank
