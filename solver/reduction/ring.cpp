// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"
#include "solver/reduction/tooth_responses.hpp"

#include <complex>

namespace flank
{
  ToothResponses ring_responses(const CondensedSector &sector, const int teeth, const int max_offset)
  {
    FLANK_ASSERT(max_offset >= 0 && 2 * max_offset <= teeth, "offsets within half the ring");
    using Complex                  = std::complex<double>;
    const Eigen::Index n_flank     = sector.n_flank();
    const int          n_harmonics = teeth / 2 + 1;
    const double       pitch       = 2 * units::pi / teeth;
    const bool         deep        = sector.n_outputs() > n_flank;

    // Harmonic h: u(t) = u_h exp(i h t pitch), so u_plus = exp(i h pitch) u_minus in the next tooth's axes.
    ToothResponses sums(max_offset + 1, Eigen::MatrixXd::Zero(n_flank, n_flank));
    sums[0].setZero(sector.n_outputs(), n_flank);
    // Summed in a fixed order whatever thread computed a harmonic, so the result never depends on the threads.
    const int batch = std::max(1, available_threads());
    for (int first = 0; first < n_harmonics; first += batch)
      {
        std::vector<Eigen::MatrixXcd> responses(std::min(batch, n_harmonics - first));
        parallel_for(static_cast<int>(responses.size()), [&](const int b) {
          const Complex    phase  = std::polar(1.0, (first + b) * pitch);
          Eigen::MatrixXcd system = (sector.plus_plus + sector.minus_minus).cast<Complex>();
          system += std::conj(phase) * sector.plus_minus.cast<Complex>() + phase * sector.plus_minus.transpose().cast<Complex>();
          const Eigen::LLT<Eigen::Ref<Eigen::MatrixXcd>> factor(system);
          if (factor.info() != Eigen::Success)
            throw ComputationError("the condensed ring is not positive definite");
          Eigen::MatrixXcd load = std::conj(phase) * sector.load_plus.cast<Complex>() + sector.load_minus.cast<Complex>();
          factor.matrixL().solveInPlace(load);
          if (!deep)
            responses[b] = load.adjoint() * load;
          else
            {
              Eigen::MatrixXcd output = phase * sector.output_plus.cast<Complex>() + sector.output_minus.cast<Complex>();
              output.adjointInPlace();
              factor.matrixL().solveInPlace(output);
              responses[b] = output.adjoint() * load;
            }
        });
        for (int b = 0; b < static_cast<int>(responses.size()); ++b)
          {
            const int    h      = first + b;
            const double weight = (h == 0 || 2 * h == teeth ? 1.0 : 2.0) / teeth;
            sums[0] += weight * responses[b].real();
            for (int m = 1; m <= max_offset; ++m)
              sums[m] += weight * (std::polar(1.0, h * m * pitch) * responses[b].topRows(n_flank)).real();
          }
      }
    sums[0] += sector.own;
    return sums;
  }
} // namespace flank
