// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/reduction/condensed_sector.hpp"

#include <Eigen/SparseCore>

#include <complex>

namespace flank
{
  using Complex = std::complex<double>;

  struct ComplexParts
  {
    Eigen::MatrixXd real, imaginary;
  };

  /// The ring's equations, harmonic by harmonic. Harmonic h is u(t) = u_h exp(i h t pitch), so that u_plus =
  /// phase u_minus in the next tooth's axes, with phase = exp(i h pitch). The cuts' stiffness becomes the
  /// Hermitian matrix K = A + conj(phase) B + phase B', where A = K_++ + K_-- and B = K_+-. Forces that act
  /// on both cuts of a sector, p on the plus and m on the minus cut, become conj(phase) p + m. Square
  /// matrices are kept as Cholesky factors L, and X'K^-1 Y as the product of half solutions, L^-1 X and L^-1
  /// Y.
  class ComplexRingEquations
  {
  public:
    explicit ComplexRingEquations(const CondensedSector &sector) ///< kept by reference
        : sector_(sector)
    {
    }

    /// Forces on both cuts, a column a load, ready for half_solution().
    struct Sides
    {
      Eigen::MatrixXd plus, minus;
    };
    Sides sides(const Eigen::MatrixXd &plus, const Eigen::MatrixXd &minus) const { return { plus, minus }; }

    /// Throws ComputationError where K is not positive definite.
    Eigen::MatrixXcd factor(Complex phase) const;
    Eigen::MatrixXcd half_solution(const Eigen::MatrixXcd &factor, const Sides &sides, Complex phase) const;
    ComplexParts product(const Eigen::MatrixXcd &first,
                         const Eigen::MatrixXcd &second) const; ///< first' second
    ComplexParts square(const Eigen::MatrixXcd &half) const { return product(half, half); }
    Eigen::VectorXcd solve(const Eigen::MatrixXcd &factor, const Eigen::VectorXcd &force) const;

  private:
    const CondensedSector &sector_;
  };

  /// The ring's equations (as ComplexRingEquations) in real numbers, for a sector with a symmetry T that
  /// swaps its cuts: T A T = A and T B T = B', hence T conj(K) T = K. In an orthonormal basis V of T's
  /// eigenvectors, those of -1 times i, K is a real symmetric matrix: a quarter of the work.
  class RealRingEquations
  {
  public:
    explicit RealRingEquations(const CondensedSector &sector);

    /// Forces on both cuts in the basis V, a column a load, ready for half_solution().
    struct Sides
    {
      Eigen::MatrixXd plus, minus;
    };
    Sides sides(const Eigen::MatrixXd &plus, const Eigen::MatrixXd &minus) const;

    Eigen::MatrixXd factor(Complex phase) const;
    Eigen::MatrixXd half_solution(const Eigen::MatrixXd &factor, const Sides &sides,
                                  Complex phase) const; ///< real parts, then imaginary ones
    ComplexParts product(const Eigen::MatrixXd &first, const Eigen::MatrixXd &second) const;
    ComplexParts square(const Eigen::MatrixXd &half) const;
    Eigen::VectorXcd solve(const Eigen::MatrixXd &factor, const Eigen::VectorXcd &force) const;

  private:
    Eigen::SparseMatrix<double> basis_;            ///< V: eigenvectors of +1, then of -1
    Eigen::Index n_even_ = 0;                      ///< how many eigenvectors are of +1
    Eigen::MatrixXd stiffness_, sum_, difference_; ///< A, B + B', B' - B in the basis
  };
} // namespace flank
