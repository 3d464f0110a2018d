// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"
#include "solver/reduction/tooth_responses.hpp"

namespace flank
{
  ToothResponses segment_responses(const CondensedSector &sector, const int teeth, const bool clamped_cuts, const int max_offset)
  {
    FLANK_ASSERT(teeth >= 1 && teeth % 2 == 1, "an odd number of teeth");
    const Eigen::Index n = sector.n_cut(), n_flank = sector.n_flank();
    const int          centre = teeth / 2, first = clamped_cuts ? 1 : 0, last = clamped_cuts ? teeth - 1 : teeth;

    // Cut t lies before tooth t (its minus cut), cut t + 1 behind it. D: diagonal blocks, plus_minus: block (t + 1, t).
    // Block Cholesky D = L L', the load entering at the cuts of the loaded tooth; both kept for the way back.
    std::vector<Eigen::LLT<Eigen::MatrixXd>> factor(teeth + 1);
    std::vector<Eigen::MatrixXd>             coupling(teeth + 1), displacement(teeth + 1, Eigen::MatrixXd::Zero(n, n_flank));
    displacement[centre] += sector.load_minus;
    displacement[centre + 1] += sector.load_plus;
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

    const auto response = [&](const int tooth) -> Eigen::MatrixXd {
      return sector.output_plus * displacement[tooth + 1] + sector.output_minus * displacement[tooth];
    };
    ToothResponses result{ response(centre) + sector.own };
    for (int m = 1; m <= max_offset; ++m)
      result.push_back(
          m > centre ? Eigen::MatrixXd(Eigen::MatrixXd::Zero(n_flank, n_flank))
                     : Eigen::MatrixXd(0.5 * (response(centre + m).topRows(n_flank) + response(centre - m).topRows(n_flank).transpose())));
    return result;
  }
} // namespace flank
