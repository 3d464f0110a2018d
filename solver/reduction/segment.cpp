// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/reduction/tooth_responses.hpp"

namespace flank
{
  namespace
  {
    /// Displacements of all cuts of a segment, in the axes of the tooth behind each, for forces on the cuts
    /// of its middle tooth (a column a load). Cut t lies before tooth t (its minus cut), cut t + 1 behind it.
    std::vector<Eigen::MatrixXd> chain(const CondensedSector &sector, const int teeth,
                                       const bool clamped_cuts, const Eigen::MatrixXd &load_minus,
                                       const Eigen::MatrixXd &load_plus)
    {
      FLANK_ASSERT(teeth >= 1 && teeth % 2 == 1, "an odd number of teeth");
      const Eigen::Index n = sector.n_cut();
      const int centre = teeth / 2, first = clamped_cuts ? 1 : 0, last = clamped_cuts ? teeth - 1 : teeth;

      // D: diagonal blocks, plus_minus: block (t + 1, t). Block Cholesky D = L L', the load entering at the
      // cuts of the loaded tooth; both kept for the way back.
      std::vector<Eigen::LLT<Eigen::MatrixXd>> factor(teeth + 1);
      std::vector<Eigen::MatrixXd> coupling(teeth + 1),
          displacement(teeth + 1, Eigen::MatrixXd::Zero(n, load_minus.cols()));
      displacement[centre] += load_minus;
      displacement[centre + 1] += load_plus;
      for (int t = first; t <= last; ++t)
        {
          Eigen::MatrixXd diagonal = Eigen::MatrixXd::Zero(n, n);
          if (t < teeth)
            diagonal += sector.minus_minus;
          if (t > 0)
            diagonal += sector.plus_plus;
          if (t > first)
            {
              coupling[t - 1] = factor[t - 1].matrixL().solve(sector.plus_minus.transpose());
              diagonal.noalias() -= coupling[t - 1].transpose() * coupling[t - 1];
              displacement[t].noalias() -= coupling[t - 1].transpose() * displacement[t - 1];
            }
          factor[t].compute(diagonal);
          if (factor[t].info() != Eigen::Success)
            throw ComputationError("the condensed segment is not positive definite");
          factor[t].matrixL().solveInPlace(displacement[t]);
        }
      if (clamped_cuts)
        displacement[0].setZero(), displacement[teeth].setZero(); // of a single tooth both cuts are clamped
      for (int t = last; t >= first; --t)
        {
          if (t < last)
            displacement[t].noalias() -= coupling[t] * displacement[t + 1];
          factor[t].matrixU().solveInPlace(displacement[t]);
        }
      return displacement;
    }
  } // namespace

  ToothResponses segment_responses(const CondensedSector &sector, const int teeth, const bool clamped_cuts,
                                   const int max_offset)
  {
    const int centre = teeth / 2;
    const Eigen::Index n_flank = sector.n_flank();
    const std::vector<Eigen::MatrixXd> displacement =
        chain(sector, teeth, clamped_cuts, sector.load_minus, sector.load_plus);
    const auto response = [&](const int tooth) -> Eigen::MatrixXd {
      return sector.output_plus * displacement[tooth + 1] + sector.output_minus * displacement[tooth];
    };
    ToothResponses result{ response(centre) + sector.own };
    for (int m = 1; m <= max_offset; ++m)
      result.push_back(m > centre
                           ? Eigen::MatrixXd(Eigen::MatrixXd::Zero(n_flank, n_flank))
                           : Eigen::MatrixXd(0.5 * (response(centre + m).topRows(n_flank) +
                                                    response(centre - m).topRows(n_flank).transpose())));
    return result;
  }

  CutDisplacements segment_cuts(const CondensedSector &sector, const BodyModel &model, const double pitch,
                                const std::vector<TeethLoads> &loads, const std::vector<int> &wanted)
  {
    // Load case by load case, so that the last bit of one does not depend on what others there are.
    CutDisplacements result(loads.size());
    parallel_for(static_cast<int>(loads.size()), [&](const int k) {
      for (const int tooth : wanted)
        result[k][tooth] = { Eigen::VectorXd::Zero(sector.n_cut()), Eigen::VectorXd::Zero(sector.n_cut()) };
      if (loads[k].empty())
        return;
      Eigen::MatrixXd force(sector.n_flank(), static_cast<Eigen::Index>(
                                                  loads[k].size())); // each in a segment around its own tooth
      Eigen::Index column = 0;
      for (const auto &[loaded, of_tooth] : loads[k])
        force.col(column++) = of_tooth;
      const auto cuts = chain(sector, model.segment_teeth, model.clamped_cuts, sector.load_minus * force,
                              sector.load_plus * force);
      column = 0;
      for (const auto &[loaded, of_tooth] : loads[k])
        {
          for (auto &[tooth, sum] : result[k])
            if (const int place = tooth - loaded + model.segment_teeth / 2;
                place >= 0 && place < model.segment_teeth)
              {
                sum.minus += cuts[place].col(column);
                sum.plus += turned(cuts[place + 1].col(column), pitch);
              }
          ++column;
        }
    });
    return result;
  }
} // namespace flank
