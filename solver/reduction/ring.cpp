// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"
#include "solver/reduction/tooth_responses.hpp"

#include <complex>

namespace flank
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Harmonic h of the ring: u(t) = u_h exp(i h t pitch), so u_plus = exp(i h pitch) u_minus in the next tooth's axes. `phase`: that
    /// factor. Stiffness of a cut.
    Eigen::MatrixXcd ring_stiffness(const CondensedSector &sector, const Complex phase)
    {
      Eigen::MatrixXcd system = (sector.plus_plus + sector.minus_minus).cast<Complex>();
      system += std::conj(phase) * sector.plus_minus.cast<Complex>() + phase * sector.plus_minus.transpose().cast<Complex>();
      return system;
    }

    /// Forces on a cut for unit loads on the flank nodes, of the same harmonic.
    Eigen::MatrixXcd ring_load(const CondensedSector &sector, const Complex phase)
    {
      return std::conj(phase) * sector.load_plus.cast<Complex>() + sector.load_minus.cast<Complex>();
    }

    /// In place of a stiffness matrix: its Cholesky factor.
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXcd>> factored(Eigen::MatrixXcd &system)
    {
      Eigen::LLT<Eigen::Ref<Eigen::MatrixXcd>> factor(system);
      if (factor.info() != Eigen::Success)
        throw ComputationError("the condensed ring is not positive definite");
      return factor;
    }
  } // namespace

  ToothResponses ring_responses(const CondensedSector &sector, const int teeth, const int max_offset)
  {
    FLANK_ASSERT(max_offset >= 0 && 2 * max_offset <= teeth, "offsets within half the ring");
    const Eigen::Index n_flank     = sector.n_flank();
    const int          n_harmonics = teeth / 2 + 1;
    const double       pitch       = 2 * units::pi / teeth;
    const bool         deep        = sector.n_outputs() > n_flank;

    ToothResponses sums(max_offset + 1, Eigen::MatrixXd::Zero(n_flank, n_flank));
    sums[0].setZero(sector.n_outputs(), n_flank);
    // Summed in a fixed order whatever thread computed a harmonic, so the result never depends on the threads.
    const int batch = std::max(1, available_threads());
    for (int first = 0; first < n_harmonics; first += batch)
      {
        std::vector<Eigen::MatrixXcd> responses(std::min(batch, n_harmonics - first));
        parallel_for(static_cast<int>(responses.size()), [&](const int b) {
          const Complex    phase  = std::polar(1.0, (first + b) * pitch);
          Eigen::MatrixXcd system = ring_stiffness(sector, phase), load = ring_load(sector, phase);
          const auto       factor = factored(system);
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

  CutDisplacements ring_cuts(const CondensedSector &sector, const int teeth, const std::vector<TeethLoads> &loads,
                             const std::vector<int> &wanted)
  {
    const double pitch       = 2 * units::pi / teeth;
    const int    n_harmonics = teeth / 2 + 1;
    // Load case by load case, so that the last bit of one does not depend on what others there are.
    std::vector<std::vector<Eigen::VectorXcd>> minus(n_harmonics, std::vector<Eigen::VectorXcd>(loads.size())); // displacement of a cut
    parallel_for(n_harmonics, [&](const int h) {
      const Complex          phase  = std::polar(1.0, h * pitch);
      Eigen::MatrixXcd       system = ring_stiffness(sector, phase);
      const auto             factor = factored(system);
      const Eigen::MatrixXcd unit   = ring_load(sector, phase);
      for (std::size_t k = 0; k < loads.size(); ++k)
        {
          Eigen::VectorXcd force = Eigen::VectorXcd::Zero(sector.n_flank());
          for (const auto &[tooth, load] : loads[k])
            force += std::polar(1.0 / teeth, -h * tooth * pitch) * load.cast<Complex>();
          minus[h][k] = factor.solve(unit * force);
        }
    });
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    CutDisplacements      result(loads.size());
    for (std::size_t k = 0; k < loads.size(); ++k)
      {
        const auto before = [&](const int tooth) {
          Eigen::VectorXd sum = Eigen::VectorXd::Zero(sector.n_cut());
          for (int h = 0; h < n_harmonics; ++h)
            sum += (h == 0 || 2 * h == teeth ? 1.0 : 2.0) * (std::polar(1.0, h * tooth * pitch) * minus[h][k]).real();
          return sum;
        };
        for (const int tooth : wanted)
          {
            Eigen::VectorXd plus = before(tooth + 1);
            for (Eigen::Index i = 0; i < plus.size(); i += 3)
              plus.segment<3>(i) = (turn * plus.segment<3>(i)).eval();
            result[k][tooth] = { before(tooth), plus };
          }
      }
    return result;
  }
} // namespace flank
