// SPDX-License-Identifier: GPL-2.0-or-later
// designs.csv: what a study's variants are, a row a load.
#include "cases/results/csv_cell.hpp"
#include "cases/results/harmonics.hpp"
#include "cases/results/transmission_error_curve.hpp"
#include "cases/study/study_results.hpp"
#include "cases/study/table_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr int n_harmonics = 5;

    std::string torques_of(const std::vector<DesignTorque> &minima)
    {
      std::string result;
      for (const DesignTorque &minimum : minima)
        result += fmt::format("{}{:.9g}", result.empty() ? "" : ";", minimum.torque);
      return result;
    }

    constexpr const char *bound_columns = ",mean_te_bound_um,peak_to_peak_bound_um,A1_bound_um,A2_bound_um,"
                                          "A3_bound_um,max_pressure_bound_MPa,pressure_kind";
    constexpr int n_bounds = 7;

    /// Cells of these columns, empty where nothing is estimated; the kind is known wherever it was tried.
    std::string cells_of(const std::vector<DesignBounds> &bounds, const std::size_t load)
    {
      if (load >= bounds.size())
        return std::string(n_bounds, ',');
      const auto &[mean, peak_to_peak, amplitude, max_pressure, pressure_kind] = bounds[load];
      std::string cells;
      for (const double bound :
           { mean, peak_to_peak, amplitude[0], amplitude[1], amplitude[2], max_pressure })
        cells += std::isnan(bound) ? "," : fmt::format(",{:.9g}", bound);
      return cells + "," + pressure_kind;
    }
  } // namespace

  /// What every row of a variant begins with: its number and the values of its keys.
  std::string StudyTable::head_of_row(const std::size_t variant) const
  {
    std::string head = fmt::format("{}", variant);
    for (const std::string &value : axes_.values(static_cast<long>(variant)))
      head += "," + csv_cell(value);
    return head;
  }

  /// A row for a variant without results, or for each of its loads that has none; `columns`: how many follow
  /// the status, the first of them the load.
  void StudyTable::write_failures(TableFile &stream, const std::size_t variant,
                                  const std::size_t columns) const
  {
    const Variant &v = variants_[variant];
    const auto row = [&](const std::string &why, const std::string &load) {
      stream << head_of_row(variant) << "," << csv_cell("failed: " + why) << "," << load
             << std::string(columns - 1, ',') << "\n";
    };
    if (!v.failure.empty())
      row(v.failure, "");
    for (const FailedLoad &failed : v.left_out)
      row(failed.why, fmt::format("{:.9g}", failed.load));
  }

  void StudyTable::write_designs(const std::string &path,
                                 const std::map<long, std::vector<DesignBounds>> &bounds) const
  {
    TableFile stream(path);
    const StudyColumns columns = work_.columns();
    if (!columns.over_positions)
      return write_designs_of_one_position(stream);
    stream << study_conventions << "variant";
    for (const std::string &key : axes_.keys())
      stream << "," << key;
    stream.print(",status,{},mean_{}_um,peak_to_peak_um", columns.load_head(), columns.value);
    for (int i = 1; i <= n_harmonics; ++i)
      stream.print(",A{}_um", i);
    stream.print(",T_d_by_A1_Nm,T_d_by_peak_to_peak_Nm,max_pressure_MPa,edge_pressure_MPa,mean_{}_N_per_um",
                 columns.stiffness);
    if (columns.has_bounds)
      stream << bound_columns;
    const std::string mean = std::string("mean_") + columns.value;
    for (const std::string &key : parameters_)
      for (const char *quantity : { mean.c_str(), "peak_to_peak", "A1", "A2", "A3" })
        stream.print(",d_{}_um/d_{}", quantity, key);
    stream << "\n";
    for (std::size_t n = 0; n < variants_.size(); ++n)
      {
        if (variants_[n].failure.empty())
          {
            const auto found = bounds.find(static_cast<long>(n));
            write_design(stream, n, found != bounds.end() ? found->second : std::vector<DesignBounds>());
          }
        write_failures(stream, n,
                       8 + n_harmonics + (columns.has_bounds ? n_bounds : 0) + 5 * parameters_.size());
      }
    stream.finish();
  }

  /// A row for each load of a variant. `bounds`: of these loads, as far as they are estimated.
  void StudyTable::write_design(TableFile &stream, const std::size_t variant,
                                const std::vector<DesignBounds> &bounds) const
  {
    const Variant &v = variants_[variant];
    const std::string head = head_of_row(variant);
    const TransmissionErrorCurve curve(*v.frame, v.points);
    const bool periodic = v.frame->period > 0;
    const std::string by_a1 = periodic ? torques_of(curve.torques_of_least_amplitude()) : "";
    const std::string by_peaks = torques_of(curve.torques_of_least_peak_to_peak());
    const bool has_bounds = work_.columns().has_bounds;
    const auto torques = v.frame->loads.size(), positions = v.frame->abscissa.size();
    for (std::size_t t = 0; t < torques; ++t)
      {
        const double torque = v.frame->loads[t];
        const auto mean_of = [&](double StudyPoint::*quantity) {
          return mean_over_period(*v.frame,
                                  [&](const std::size_t k) { return v.points[k * torques + t].*quantity; });
        };
        double pressure = 0, edge = 0;
        for (std::size_t k = 0; k < positions; ++k)
          {
            const StudyPoint &p = v.points[k * torques + t];
            pressure = std::max(pressure, p.max_pressure);
            edge = std::max(edge, p.edge_pressure);
          }
        stream.print("{},ok,{:.9g},{:.9f},{:.9f}", head, torque, mean_of(&StudyPoint::response),
                     curve.peak_to_peak(torque));
        for (int i = 1; i <= n_harmonics; ++i)
          {
            const double amplitude = periodic ? curve.amplitude(torque, i) : std::nan("");
            stream << (std::isnan(amplitude) ? "," : fmt::format(",{:.9f}", amplitude));
          }
        stream.print(",{},{},{:.4f},{:.4f},{:.6f}{}{}\n", by_a1, by_peaks, pressure, edge,
                     mean_of(&StudyPoint::stiffness), has_bounds ? cells_of(bounds, t) : "",
                     derivatives(v, t));
      }
  }

  /// A row a load: what every variant has there.
  void StudyTable::write_designs_of_one_position(TableFile &stream) const
  {
    const StudyColumns columns = work_.columns();
    stream << "variant";
    for (const std::string &key : axes_.keys())
      stream << "," << key;
    stream.print(",status,{},{}_um,max_pressure_MPa,edge_pressure_MPa,{}_N_per_um,certificate\n",
                 columns.load_head(), columns.value, columns.stiffness);
    for (std::size_t n = 0; n < variants_.size(); ++n)
      {
        const Variant &v = variants_[n];
        for (std::size_t t = 0; v.failure.empty() && t < v.points.size(); ++t)
          stream.print("{},ok,{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.3e}\n", head_of_row(n), v.frame->loads[t],
                       v.points[t].response, v.points[t].max_pressure, v.points[t].edge_pressure,
                       v.points[t].stiffness, v.points[t].certificate);
        write_failures(stream, n, 6);
      }
    stream.finish();
  }

  /// Columns of one row: of mean, peak-to-peak and A1 to A3 by every parameter; empty where a variant does
  /// not have it.
  std::string StudyTable::derivatives(const Variant &variant, const std::size_t torque) const
  {
    const VariantFrame &frame = *variant.frame;
    const std::size_t torques = frame.loads.size(), count = frame.parameters.size();
    std::vector<double> te;
    for (std::size_t k = 0; k < static_cast<std::size_t>(frame.period); ++k)
      te.push_back(variant.points[k * torques + torque].response);
    const auto [low, high] = std::minmax_element(te.begin(), te.end());
    std::string columns;
    for (const std::string &key : parameters_)
      {
        const auto it = std::find(frame.parameters.begin(), frame.parameters.end(), key);
        if (it == frame.parameters.end())
          {
            columns += ",,,,,";
            continue;
          }
        std::vector<double> by;
        for (std::size_t k = 0; k < te.size(); ++k)
          by.push_back(variant.derivatives[(k * torques + torque) * count +
                                           static_cast<std::size_t>(it - frame.parameters.begin())]);
        const double mean = mean_over_period(frame, [&](const std::size_t k) { return by[k]; });
        columns += fmt::format(",{:.9g},{:.9g}", mean, by[high - te.begin()] - by[low - te.begin()]);
        for (const int harmonic : { 1, 2, 3 })
          columns += 2 * harmonic * frame.order <= frame.period
                         ? fmt::format(",{:.9g}", amplitude_derivative(te, by, harmonic * frame.order))
                         : ",";
      }
    return columns;
  }
} // namespace flank
