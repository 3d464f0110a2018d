// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/reduction/ring_equations.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"
#include "solver/reduction/tooth_responses.hpp"

namespace flank
{
  namespace
  {
    double weight_of(const int harmonic, const int teeth)
    {
      return harmonic == 0 || 2 * harmonic == teeth ? 1.0 : 2.0;
    }

    template <class Equations>
    ToothResponses responses(const Equations &equations, const CondensedSector &sector, const int teeth,
                             const int max_offset)
    {
      const Eigen::Index n_flank = sector.n_flank();
      const int n_harmonics = teeth / 2 + 1;
      const double pitch = 2 * units::pi / teeth;
      const bool deep = sector.n_outputs() > n_flank;

      const auto load = equations.sides(sector.load_plus, sector.load_minus);
      const auto output =
          deep ? equations.sides(sector.output_plus.transpose(), sector.output_minus.transpose())
               : typename Equations::Sides();
      ToothResponses sums(max_offset + 1, Eigen::MatrixXd::Zero(n_flank, n_flank));
      sums[0].setZero(sector.n_outputs(), n_flank);
      // Summed in a fixed order whatever thread computed a harmonic, so the result never depends on the
      // threads.
      const int batch = std::max(1, available_threads());
      for (int first = 0; first < n_harmonics; first += batch)
        {
          std::vector<ComplexParts> of_harmonic(std::min(batch, n_harmonics - first));
          parallel_for(static_cast<int>(of_harmonic.size()), [&](const int b) {
            const Complex phase = std::polar(1.0, (first + b) * pitch);
            const auto factor = equations.factor(phase);
            const auto half = equations.half_solution(factor, load, phase);
            of_harmonic[b] = deep ? equations.product(equations.half_solution(factor, output, phase), half)
                                  : equations.square(half);
          });
          for (int b = 0; b < static_cast<int>(of_harmonic.size()); ++b)
            {
              const int h = first + b;
              const double weight = weight_of(h, teeth) / teeth;
              ComplexParts &r = of_harmonic[b];
              sums[0] += weight * r.real;
              for (int m = 1; m <= max_offset; ++m)
                sums[m] += weight * (std::cos(h * m * pitch) * r.real.topRows(n_flank) -
                                     std::sin(h * m * pitch) * r.imaginary.topRows(n_flank));
            }
        }
      sums[0] += sector.own;
      return sums;
    }

    /// Displacements of the minus cut: [harmonic][load case]. Load case by load case, so that the last bit of
    /// one does not depend on what others there are.
    template <class Equations>
    std::vector<std::vector<Eigen::VectorXcd>> harmonics(const Equations &equations,
                                                         const CondensedSector &sector, const int teeth,
                                                         const std::vector<TeethLoads> &loads)
    {
      const double pitch = 2 * units::pi / teeth;
      std::vector<std::vector<Eigen::VectorXcd>> minus(teeth / 2 + 1,
                                                       std::vector<Eigen::VectorXcd>(loads.size()));
      parallel_for(static_cast<int>(minus.size()), [&](const int h) {
        const Complex phase = std::polar(1.0, h * pitch);
        const auto factor = equations.factor(phase);
        for (std::size_t k = 0; k < loads.size(); ++k)
          {
            Eigen::VectorXcd force = Eigen::VectorXcd::Zero(sector.n_flank());
            for (const auto &[tooth, load] : loads[k])
              force += std::polar(1.0 / teeth, -h * tooth * pitch) * Eigen::VectorXcd(load);
            minus[h][k] = equations.solve(factor, std::conj(phase) * (sector.load_plus * force) +
                                                      sector.load_minus * force);
          }
      });
      return minus;
    }
  } // namespace

  ToothResponses ring_responses(const CondensedSector &sector, const int teeth, const int max_offset)
  {
    FLANK_ASSERT(max_offset >= 0 && 2 * max_offset <= teeth, "offsets within half the ring");
    if (sector.symmetry)
      return responses(RealRingEquations(sector), sector, teeth, max_offset);
    return responses(ComplexRingEquations(sector), sector, teeth, max_offset);
  }

  CutDisplacements ring_cuts(const CondensedSector &sector, const int teeth,
                             const std::vector<TeethLoads> &loads, const std::vector<int> &wanted)
  {
    const double pitch = 2 * units::pi / teeth;
    const auto minus = sector.symmetry ? harmonics(RealRingEquations(sector), sector, teeth, loads)
                                       : harmonics(ComplexRingEquations(sector), sector, teeth, loads);
    CutDisplacements result(loads.size());
    for (std::size_t k = 0; k < loads.size(); ++k)
      {
        const auto before = [&](const int tooth) {
          Eigen::VectorXd sum = Eigen::VectorXd::Zero(sector.n_cut());
          for (int h = 0; h < static_cast<int>(minus.size()); ++h)
            sum += weight_of(h, teeth) * (std::polar(1.0, h * tooth * pitch) * minus[h][k]).real();
          return sum;
        };
        for (const int tooth : wanted)
          result[k][tooth] = { before(tooth), turned(before(tooth + 1), pitch) };
      }
    return result;
  }
} // namespace flank
