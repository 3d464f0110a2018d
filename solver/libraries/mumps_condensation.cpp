// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"
#include "solver/libraries/module.hpp"
#include "solver/libraries/mumps_failure.hpp"

#include <dmumps_c.h>
#include <metis.h>
#include <mpi.h>

#include <fmt/format.h>

// MUMPS is called here without PETSc, which passes no ordering on to its Cholesky factorisation. With a Schur
// complement MUMPS itself orders by minimum degree, which takes two thirds more operations than METIS's order
// (64 against 38 GFlop for the helical example).

namespace flank
{
  namespace
  {
    /// The unknowns that are not held: which are kept, which MUMPS number (from 1) each has.
    struct FreeUnknowns
    {
      FreeUnknowns(const std::vector<char> &fixed, const std::vector<int> &kept)
          : number(fixed.size(), 0)
          , is_kept(fixed.size(), 0)
      {
        for (std::size_t i = 0; i < fixed.size(); ++i)
          if (!fixed[i])
            number[i] = ++count;
        for (const int k : kept)
          {
            FLANK_ASSERT(number[k] > 0, "kept unknowns are free");
            is_kept[k] = 1;
          }
      }
      bool eliminated(const int i) const { return number[i] > 0 && !is_kept[i]; }

      std::vector<int> number; ///< 0: held
      std::vector<char> is_kept;
      int count = 0;
    };

    /// Nodes with unknowns to eliminate, by METIS's nested dissection.
    std::vector<int> dissected(const StiffnessMatrix &stiffness, const FreeUnknowns &unknowns)
    {
      const int n_nodes = static_cast<int>(stiffness.rows()) / 3;
      std::vector<int> vertex(n_nodes, -1), node;
      std::vector<idx_t> starts{ 0 }, neighbours;
      for (int a = 0; a < n_nodes; ++a)
        if (unknowns.eliminated(3 * a) || unknowns.eliminated(3 * a + 1) || unknowns.eliminated(3 * a + 2))
          {
            vertex[a] = static_cast<int>(node.size());
            node.push_back(a);
          }
      for (const int a : node)
        {
          for (StiffnessMatrix::InnerIterator it(stiffness, 3 * a); it; ++it)
            if (const int b = static_cast<int>(it.col()) / 3; it.col() % 3 == 0 && b != a && vertex[b] >= 0)
              neighbours.push_back(vertex[b]);
          starts.push_back(static_cast<idx_t>(neighbours.size()));
        }
      idx_t count = static_cast<idx_t>(node.size()), options[METIS_NOPTIONS];
      std::vector<idx_t> order(node.size()), place(node.size());
      METIS_SetDefaultOptions(options);
      options[METIS_OPTION_SEED] = 1;
      if (count > 0 && METIS_NodeND(&count, starts.data(), neighbours.data(), nullptr, options, order.data(),
                                    place.data()) != METIS_OK)
        throw LibraryError("METIS could not order the stiffness matrix");
      std::vector<int> result;
      for (const idx_t v : order)
        result.push_back(node[v]);
      return result;
    }

    /// A matrix that MUMPS factors, on this process alone.
    class Mumps
    {
    public:
      Mumps()
      {
        data_.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(MPI_COMM_SELF));
        data_.par = 1;
        data_.sym = 1; // positive definite
        run(-1, "start");
        for (const int output : { 1, 2, 3 })
          control(output) = -1;
        control(4) = 0;
      }
      ~Mumps()
      {
        data_.job = -2;
        dmumps_c(&data_);
      }
      Mumps(const Mumps &) = delete;

      /// ICNTL(i) of the users' guide.
      MUMPS_INT &control(const int i) { return data_.icntl[i - 1]; }

      void run(const int job, const char *what)
      {
        data_.job = job;
        dmumps_c(&data_);
        require_factored(data_.infog[0], what);
      }

      DMUMPS_STRUC_C &data() { return data_; }

    private:
      DMUMPS_STRUC_C data_{};
    };
  } // namespace

  namespace
  {
    /// Solves with the factor that a condensation leaves.
    class CondensedInside final : public DirectSolver
    {
    public:
      CondensedInside(const StiffnessMatrix &stiffness, FreeUnknowns unknowns, std::unique_ptr<Mumps> mumps)
          : stiffness_(stiffness)
          , unknowns_(std::move(unknowns))
          , mumps_(std::move(mumps))
      {
      }

      Eigen::VectorXd solve(const Eigen::VectorXd &load, const Eigen::VectorXd &prescribed) const override
      {
        Eigen::VectorXd result = prescribed.size() > 0 ? prescribed : Eigen::VectorXd::Zero(load.size());
        for (int i = 0; i < result.size(); ++i)
          if (unknowns_.eliminated(i))
            result[i] = 0;
        const Eigen::VectorXd right = load - stiffness_ * result;
        std::vector<double> x(unknowns_.count, 0.0);
        for (int i = 0; i < result.size(); ++i)
          if (unknowns_.eliminated(i))
            x[unknowns_.number[i] - 1] = right[i];
        mumps_->data().rhs = x.data();
        mumps_->data().nrhs = 1;
        mumps_->data().lrhs = unknowns_.count;
        mumps_->run(3, "solution");
        for (int i = 0; i < result.size(); ++i)
          if (unknowns_.eliminated(i))
            result[i] = x[unknowns_.number[i] - 1];
        return result;
      }

    private:
      StiffnessMatrix stiffness_;
      FreeUnknowns unknowns_;
      std::unique_ptr<Mumps> mumps_;
    };
  } // namespace

  Condensation mumps_condense(const StiffnessMatrix &stiffness, const std::vector<char> &fixed,
                              const std::vector<int> &kept, const bool keep_inside)
  {
    FLANK_ASSERT(static_cast<Eigen::Index>(fixed.size()) == stiffness.rows(), "one flag an unknown");
    const FreeUnknowns unknowns(fixed, kept);
    std::vector<MUMPS_INT> rows, columns, position(unknowns.count), of_kept;
    std::vector<double> values;
    for (Eigen::Index i = 0; i < stiffness.rows(); ++i)
      if (unknowns.number[i] > 0)
        for (StiffnessMatrix::InnerIterator it(stiffness, i); it; ++it)
          if (it.col() >= i && unknowns.number[it.col()] > 0)
            {
              rows.push_back(unknowns.number[i]);
              columns.push_back(unknowns.number[it.col()]);
              values.push_back(it.value());
            }
    int next = 0;
    for (const int node : dissected(stiffness, unknowns))
      for (int i = 3 * node; i < 3 * node + 3; ++i)
        if (unknowns.eliminated(i))
          position[unknowns.number[i] - 1] = ++next;
    for (const int k : kept)
      {
        of_kept.push_back(unknowns.number[k]);
        position[unknowns.number[k] - 1] = ++next;
      }

    const auto n = static_cast<Eigen::Index>(kept.size());
    Eigen::MatrixXd complement = Eigen::MatrixXd::Zero(n, n);
    auto mumps = std::make_unique<Mumps>();
    mumps->control(7) = 1;                    // the ordering is given
    mumps->control(14) = 40;                  // workspace estimate, per cent
    mumps->control(19) = n > 0 ? 1 : 0;       // 1: the Schur complement by rows: of a symmetric one the lower
                                              // triangle, which is the upper by columns
    mumps->control(31) = keep_inside ? 0 : 1; // 1: the factor is thrown away
    DMUMPS_STRUC_C &data = mumps->data();
    data.n = unknowns.count;
    data.nnz = static_cast<MUMPS_INT8>(values.size());
    data.irn = rows.data();
    data.jcn = columns.data();
    data.a = values.data();
    data.perm_in = position.data();
    data.size_schur = static_cast<MUMPS_INT>(n);
    data.listvar_schur = of_kept.data();
    data.schur = complement.data();
    mumps->run(1, "analysis");
    mumps->run(2, "factorisation");
    complement.triangularView<Eigen::StrictlyLower>() = complement.transpose();
    if (!keep_inside)
      return { std::move(complement), nullptr };
    return { std::move(complement),
             std::make_unique<const CondensedInside>(stiffness, unknowns, std::move(mumps)) };
  }
} // namespace flank
