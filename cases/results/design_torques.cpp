// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/design_torques.hpp"

#include "cases/results/bounds_over_torque.hpp"
#include "cases/results/harmonics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace flank
{
  namespace
  {
    struct Minima
    {
      std::vector<DesignTorque> by_a1, by_peak_to_peak;
    };

    Minima minima_of(const VariantFrame &frame, const std::vector<StudyPoint> &points)
    {
      const TransmissionErrorCurve curve(frame, points);
      Minima minima;
      if (frame.period > 0)
        minima.by_a1 = curve.torques_of_least_amplitude();
      minima.by_peak_to_peak = curve.torques_of_least_peak_to_peak();
      return minima;
    }

    std::string listed(const std::vector<DesignTorque> &minima)
    {
      std::vector<std::string> torques;
      for (const DesignTorque &minimum : minima)
        torques.push_back(fmt::format("{:.6g} N m ({:.4f} um)", minimum.torque, minimum.value));
      return torques.empty() ? "none" : fmt::format("{}", fmt::join(torques, ", "));
    }

    /// Of a measure over torque, where bounds of the loads are given: `of_load` of each is the measure's.
    template <class OfLoad>
    std::optional<BoundsOverTorque> over_torque(const TransmissionErrorCurve &curve,
                                                const VariantFrame &frame,
                                                const std::optional<std::vector<DesignBounds>> &bounds,
                                                const OfLoad &of_load,
                                                const BoundsOverTorque::Measure &measure)
    {
      if (!bounds)
        return std::nullopt;
      std::map<double, double> stated;
      for (std::size_t t = 0; t < std::min(bounds->size(), frame.loads.size()); ++t)
        stated[frame.loads[t]] = of_load((*bounds)[t]);
      return BoundsOverTorque(curve, std::move(stated), measure);
    }

    std::optional<BoundsOverTorque> of_amplitude(const TransmissionErrorCurve &curve,
                                                 const VariantFrame &frame,
                                                 const std::optional<std::vector<DesignBounds>> &bounds,
                                                 const int harmonic)
    {
      return over_torque(
          curve, frame, bounds,
          [harmonic](const DesignBounds &b) { return b.amplitude[static_cast<std::size_t>(harmonic - 1)]; },
          [&frame, harmonic](const std::vector<double> &te) {
            return harmonic_amplitude(te, harmonic * frame.order);
          });
    }

    std::optional<BoundsOverTorque> of_peak_to_peak(const TransmissionErrorCurve &curve,
                                                    const VariantFrame &frame,
                                                    const std::optional<std::vector<DesignBounds>> &bounds)
    {
      return over_torque(
          curve, frame, bounds, [](const DesignBounds &b) { return b.peak_to_peak; }, peak_to_peak);
    }

    const std::string about_bounds =
        "# bounds: upper bounds of the errors; between computed torques with what the interpolation is "
        "expected to leave, as a torque left out shows it; nan: not estimated\n";
  } // namespace

  bool has_design_torques(const VariantFrame &frame)
  {
    return std::count_if(frame.loads.begin(), frame.loads.end(), [](const double t) { return t > 0; }) >= 2;
  }

  ResultTable design_torques(const VariantFrame &frame, const std::vector<StudyPoint> &points,
                             const std::optional<std::vector<DesignBounds>> &bounds,
                             const std::string &heading)
  {
    std::vector<ResultTable::Column> columns = { { "by", "", "{}", { "A1", "peak_to_peak" } },
                                                 torque_column(),
                                                 { "least_um", "um", "{:.9f}" } };
    if (bounds)
      columns.push_back(bound_column("least_bound_um", "um"));
    ResultTable table("design_torques",
                      heading +
                          "# local minima over torque, between the computed torques too: at every "
                          "position the cubic through values and exact slopes\n" +
                          (bounds ? about_bounds : ""),
                      columns);
    const TransmissionErrorCurve curve(frame, points);
    const auto add = [&](const double by, const std::vector<DesignTorque> &minima,
                         const std::optional<BoundsOverTorque> &of_least) {
      for (const DesignTorque &minimum : minima)
        {
          std::vector<double> row = { by, minimum.torque, minimum.value };
          if (of_least)
            row.push_back(of_least->at(minimum.torque));
          table.add(row);
        }
    };
    const Minima minima = minima_of(frame, points);
    add(0, minima.by_a1, of_amplitude(curve, frame, bounds, 1));
    add(1, minima.by_peak_to_peak, of_peak_to_peak(curve, frame, bounds));
    return table;
  }

  namespace
  {
    /// The computed torques and, over their whole range, equal steps between them.
    std::vector<double> torques_drawn(const std::vector<double> &computed)
    {
      constexpr int between = 400;
      std::vector<double> torques = computed;
      for (int k = 1; k < between; ++k)
        {
          const double torque = computed.front() + (computed.back() - computed.front()) * k / between;
          if (std::none_of(computed.begin(), computed.end(), [&](const double one) {
                return std::abs(torque - one) < 1e-9 * computed.back(); // that one again, rounded otherwise
              }))
            torques.push_back(torque);
        }
      std::sort(torques.begin(), torques.end());
      return torques;
    }
  } // namespace

  ResultTable amplitudes_over_torque(const VariantFrame &frame, const std::vector<StudyPoint> &points,
                                     const std::optional<std::vector<DesignBounds>> &bounds,
                                     const std::string &heading)
  {
    std::vector<ResultTable::Column> columns = { torque_column(),
                                                 // too few positions may not show them
                                                 { "A1_um", "um", "{:.9f}", {}, "nan" },
                                                 { "A2_um", "um", "{:.9f}", {}, "nan" },
                                                 { "peak_to_peak_um", "um", "{:.9f}" },
                                                 { "computed", "0 no, 1 yes", "{}" } };
    if (bounds)
      for (const char *name : { "A1_bound_um", "A2_bound_um", "peak_to_peak_bound_um" })
        columns.push_back(bound_column(name, "um"));
    ResultTable table("amplitudes_over_torque",
                      heading +
                          "# between the computed torques at every position the cubic through values "
                          "and exact slopes\n" +
                          (bounds ? about_bounds : ""),
                      columns);
    if (!has_design_torques(frame) || frame.period == 0)
      return table;
    const TransmissionErrorCurve curve(frame, points);
    const std::array over_torque = { of_amplitude(curve, frame, bounds, 1),
                                     of_amplitude(curve, frame, bounds, 2),
                                     of_peak_to_peak(curve, frame, bounds) };
    const std::vector<double> computed = curve.loaded_torques();
    for (const double torque : torques_drawn(computed))
      {
        std::vector<double> row = { torque, curve.amplitude(torque, 1), curve.amplitude(torque, 2),
                                    curve.peak_to_peak(torque),
                                    std::binary_search(computed.begin(), computed.end(), torque) ? 1.0
                                                                                                 : 0.0 };
        for (const std::optional<BoundsOverTorque> &of_measure : over_torque)
          if (of_measure)
            row.push_back(of_measure->at(torque));
        table.add(row);
      }
    return table;
  }

  std::string design_torque_line(const VariantFrame &frame, const std::vector<StudyPoint> &points)
  {
    if (!has_design_torques(frame))
      return {};
    const Minima minima = minima_of(frame, points);
    return fmt::format("design torques, of least A1: {}; of least peak-to-peak: {}\n", listed(minima.by_a1),
                       listed(minima.by_peak_to_peak));
  }
} // namespace flank
