// SPDX-License-Identifier: GPL-2.0-or-later
// What the module does for the rest of the solver, under the names by which the rest knows it.
#include "solver/libraries/element_libraries.hpp"

namespace flank
{
  std::unique_ptr<const ElasticBody> make_elastic_body(const HexMesh &mesh, const int degree,
                                                       const double youngs_modulus,
                                                       const double poissons_ratio)
  {
    return element_libraries().elastic_body(mesh, lobatto_abscissas(degree), youngs_modulus, poissons_ratio);
  }

  Condensation condense(const StiffnessMatrix &stiffness, const std::vector<char> &fixed,
                        const std::vector<int> &kept, const bool keep_inside)
  {
    return element_libraries().condense(stiffness, fixed, kept, keep_inside);
  }

  std::unique_ptr<const DirectSolver> make_direct_solver(const StiffnessMatrix &stiffness,
                                                         const std::vector<char> &fixed)
  {
    return condense(stiffness, fixed, {}, true).inside;
  }

  void write_vtu(const std::string &path, const FieldPiece &piece)
  {
    element_libraries().write_vtu(path, piece);
  }

  void write_pvtu(const std::string &path, const std::vector<FieldPiece::Array> &arrays,
                  const std::vector<std::string> &pieces)
  {
    element_libraries().write_pvtu(path, arrays, pieces);
  }

  void write_pvd(const std::string &path, const std::vector<std::pair<double, std::string>> &files)
  {
    element_libraries().write_pvd(path, files);
  }
} // namespace flank
