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

    /// Adds what some harmonics, the first of them `first`, make of the cuts: `minus` has the displacements
    /// of the minus cut, [harmonic][load case].
    void add_harmonics(const std::vector<std::vector<Eigen::VectorXcd>> &minus, const int first,
                       const int teeth, CutDisplacements &sums)
    {
      const double pitch = 2 * units::pi / teeth;
      for (std::size_t b = 0; b < minus.size(); ++b)
        {
          const int h = first + static_cast<int>(b);
          const auto before = [&](const int tooth, const std::size_t k) -> Eigen::VectorXd {
            return weight_of(h, teeth) * (std::polar(1.0, h * tooth * pitch) * minus[b][k]).real();
          };
          for (std::size_t k = 0; k < sums.size(); ++k)
            for (auto &[tooth, cut] : sums[k])
              {
                cut.minus += before(tooth, k);
                cut.plus += before(tooth + 1, k);
              }
        }
    }

    /// Some harmonics at a time, because all of them of all load cases can take gigabytes; in a fixed order,
    /// and load case by load case, so that the last bit of one does not depend on what others there are.
    template <class Equations>
    CutDisplacements cuts(const Equations &equations, const CondensedSector &sector, const int teeth,
                          const std::vector<TeethLoads> &loads, const std::vector<int> &wanted)
    {
      const double pitch = 2 * units::pi / teeth;
      const int n_harmonics = teeth / 2 + 1, batch = std::max(1, available_threads());
      const Eigen::VectorXd zero = Eigen::VectorXd::Zero(sector.n_cut());
      CutDisplacements result(loads.size());
      for (auto &of_case : result)
        for (const int tooth : wanted)
          of_case[tooth] = { zero, zero };
      for (int first = 0; first < n_harmonics; first += batch)
        {
          std::vector<std::vector<Eigen::VectorXcd>> minus(std::min(batch, n_harmonics - first));
          parallel_for(static_cast<int>(minus.size()), [&](const int b) {
            const int h = first + b;
            const Complex phase = std::polar(1.0, h * pitch);
            const auto factor = equations.factor(phase);
            for (const TeethLoads &of_case : loads)
              {
                Eigen::VectorXcd force = Eigen::VectorXcd::Zero(sector.n_flank());
                for (const auto &[tooth, load] : of_case)
                  force += std::polar(1.0 / teeth, -h * tooth * pitch) * Eigen::VectorXcd(load);
                minus[b].push_back(equations.solve(factor, std::conj(phase) * (sector.load_plus * force) +
                                                               sector.load_minus * force));
              }
          });
          add_harmonics(minus, first, teeth, result);
        }
      for (auto &of_case : result)
        for (auto &[tooth, cut] : of_case)
          cut.plus = turned(cut.plus, pitch);
      return result;
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
    return sector.symmetry ? cuts(RealRingEquations(sector), sector, teeth, loads, wanted)
                           : cuts(ComplexRingEquations(sector), sector, teeth, loads, wanted);
  }
} // namespace flank
