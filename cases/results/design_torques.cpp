// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/design_torques.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

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
  } // namespace

  bool has_design_torques(const VariantFrame &frame)
  {
    return std::count_if(frame.loads.begin(), frame.loads.end(), [](const double t) { return t > 0; }) >= 2;
  }

  ResultTable design_torques(const VariantFrame &frame, const std::vector<StudyPoint> &points,
                             const std::string &heading)
  {
    ResultTable table(
        "design_torques",
        heading + "# local minima over torque, between the computed torques too: at every "
                  "position the cubic through values and exact slopes\n",
        { { "by", "", "{}", { "A1", "peak_to_peak" } }, torque_column(), { "least_um", "um", "{:.9f}" } });
    const Minima minima = minima_of(frame, points);
    for (const DesignTorque &minimum : minima.by_a1)
      table.add({ 0, minimum.torque, minimum.value });
    for (const DesignTorque &minimum : minima.by_peak_to_peak)
      table.add({ 1, minimum.torque, minimum.value });
    return table;
  }

  ResultTable amplitudes_over_torque(const VariantFrame &frame, const std::vector<StudyPoint> &points,
                                     const std::string &heading)
  {
    constexpr int between = 400; // over the whole range
    ResultTable table("amplitudes_over_torque",
                      heading + "# between the computed torques at every position the cubic through values "
                                "and exact slopes\n",
                      { torque_column(),
                        { "A1_um", "um", "{:.9f}", {}, "nan" }, // too few positions may not show them
                        { "A2_um", "um", "{:.9f}", {}, "nan" },
                        { "peak_to_peak_um", "um", "{:.9f}" },
                        { "computed", "0 no, 1 yes", "{}" } });
    if (!has_design_torques(frame) || frame.period == 0)
      return table;
    const TransmissionErrorCurve curve(frame, points);
    const std::vector<double> computed = curve.loaded_torques();
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
    for (const double torque : torques)
      table.add({ torque, curve.amplitude(torque, 1), curve.amplitude(torque, 2), curve.peak_to_peak(torque),
                  std::binary_search(computed.begin(), computed.end(), torque) ? 1.0 : 0.0 });
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
