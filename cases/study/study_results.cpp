// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/study_results.hpp"

#include "cases/results/hdf5_file.hpp"
#include "cases/results/hdf5_head.hpp"
#include "cases/study/table_file.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace flank
{
  StudyTable::StudyTable(const StudyAxes &axes, const StudyWork &work)
      : axes_(axes)
      , work_(work)
      , variants_(axes.n_variants())
  {
    for (std::size_t v = 0; v < variants_.size(); ++v)
      {
        variants_[v].frame = work.frame(static_cast<long>(v));
        if (!variants_[v].frame)
          variants_[v].failure = work.refusal(static_cast<long>(v));
        else if (v == 0 || variants_[v].frame != variants_[v - 1].frame)
          for (const std::string &key : variants_[v].frame->parameters)
            if (std::find(parameters_.begin(), parameters_.end(), key) == parameters_.end())
              parameters_.push_back(key);
      }
  }

  void StudyTable::add(const long variant, const std::vector<int> &positions, StudyOutcome outcome)
  {
    Variant &v = variants_[variant];
    const auto loads = v.frame->loads.size();
    if (!outcome.failure.empty())
      {
        if (v.failure.empty()) // the first in the order of the positions
          v.failure = std::move(outcome.failure);
        return;
      }
    FLANK_ASSERT(outcome.points.size() == positions.size() * loads, "points of a piece");
    const auto place = [&](auto &all, const auto &part, const std::size_t each) {
      all.resize(v.frame->abscissa.size() * each);
      for (std::size_t k = 0; k < positions.size(); ++k)
        std::copy_n(part.begin() + static_cast<std::ptrdiff_t>(k * each), each,
                    all.begin() + static_cast<std::ptrdiff_t>(positions[k] * each));
    };
    place(v.points, outcome.points, loads);
    place(v.derivatives, outcome.derivatives, loads * v.frame->parameters.size());
    v.failures.resize(outcome.failures.empty() ? v.failures.size() : loads);
    for (std::size_t t = 0; t < outcome.failures.size(); ++t)
      if (v.failures[t].empty())
        v.failures[t] = std::move(outcome.failures[t]);
  }

  void StudyTable::leave_out_failed_loads()
  {
    for (Variant &v : variants_)
      {
        if (!v.failure.empty() || v.failures.empty())
          continue;
        const VariantFrame all = *v.frame;
        auto left = std::make_shared<VariantFrame>(all);
        left->loads.clear();
        for (std::size_t t = 0; t < all.loads.size(); ++t)
          if (v.failures[t].empty())
            left->loads.push_back(all.loads[t]);
          else
            v.left_out.push_back({ all.loads[t], v.failures[t] });
        const auto keep = [&](auto &list, const std::size_t each) {
          std::remove_reference_t<decltype(list)> kept;
          for (std::size_t point = 0; each > 0 && point < list.size() / each; ++point)
            if (v.failures[point % all.loads.size()].empty())
              kept.insert(kept.end(), list.begin() + static_cast<std::ptrdiff_t>(point * each),
                          list.begin() + static_cast<std::ptrdiff_t>((point + 1) * each));
          list = std::move(kept);
        };
        keep(v.points, 1);
        keep(v.derivatives, all.parameters.size());
        if (left->loads.empty())
          v.failure = std::exchange(v.left_out, {}).front().why;
        v.frame = std::move(left);
      }
  }

  long StudyTable::failed() const
  {
    return std::count_if(variants_.begin(), variants_.end(),
                         [](const Variant &v) { return !v.failure.empty(); });
  }

  long StudyTable::without_loads() const
  {
    return std::count_if(variants_.begin(), variants_.end(),
                         [](const Variant &v) { return !v.left_out.empty(); });
  }

  long StudyTable::without_period() const
  {
    return std::count_if(variants_.begin(), variants_.end(),
                         [](const Variant &v) { return v.failure.empty() && v.frame->period == 0; });
  }

  void StudyTable::write_te(const std::string &path) const
  {
    TableFile stream(path);
    const StudyColumns columns = work_.columns();
    stream.print("{}variant,{},position,{},{}_um,contacts,max_pressure_MPa,edge_pressure_MPa,{}_N_per_um,"
                 "certificate\n",
                 study_conventions, columns.load_head(), columns.abscissa, columns.value, columns.stiffness);
    for (std::size_t n = 0; n < variants_.size(); ++n)
      if (const Variant &v = variants_[n]; v.failure.empty())
        for (std::size_t t = 0; t < v.frame->loads.size(); ++t)
          for (std::size_t k = 0; k < v.frame->abscissa.size(); ++k)
            {
              const StudyPoint &p = v.points[k * v.frame->loads.size() + t];
              stream.print("{},{:.9g},{},{:.9g},{:.9f},{},{:.4f},{:.4f},{:.6f},{:.3e}\n", n,
                           v.frame->loads[t], k, v.frame->abscissa[k], p.response, p.contacts, p.max_pressure,
                           p.edge_pressure, p.stiffness, p.certificate);
            }
    stream.finish();
  }

  /// The numbers of the variants that have the loads and positions of variant `first`, as far as they were
  /// computed.
  std::vector<int> StudyTable::on_frame_of(const std::size_t first) const
  {
    std::vector<int> numbers;
    for (std::size_t v = first; v < variants_.size(); ++v)
      if (variants_[v].failure.empty() && *variants_[v].frame == *variants_[first].frame)
        numbers.push_back(static_cast<int>(v));
    return numbers;
  }

  void StudyTable::write_block(Hdf5File &h5, const std::string &folder, const std::vector<int> &numbers) const
  {
    const StudyColumns columns = work_.columns();
    const std::string slope_unit = columns.load_unit == std::string("N m") ? "(N m)" : columns.load_unit;
    const VariantFrame &frame = *variants_[static_cast<std::size_t>(numbers.front())].frame;
    const auto n = numbers.size(), loads = frame.loads.size(), positions = frame.abscissa.size();
    h5.dataset(folder, "variant", { n }, numbers, "1");
    h5.dataset(folder, columns.load, { loads }, frame.loads, columns.load_unit);
    h5.dataset(folder, columns.abscissa, { positions }, frame.abscissa, columns.abscissa_unit);
    h5.dataset(folder, "period", { 1 }, std::vector<int>{ frame.period }, "positions");
    h5.dataset(folder, "order", { 1 }, std::vector<int>{ frame.order }, "1");
    const std::vector<std::string> scales = { "variant", columns.load, columns.abscissa };
    // value(variant, point), points counted position by position
    const auto table = [&](const std::string &name, const std::string &unit, const auto &value) {
      std::vector<double> values;
      values.reserve(n * loads * positions);
      for (const int v : numbers)
        for (std::size_t t = 0; t < loads; ++t)
          for (std::size_t k = 0; k < positions; ++k)
            values.push_back(value(variants_[static_cast<std::size_t>(v)], k * loads + t));
      h5.dataset(folder, name, { n, loads, positions }, values, unit, scales);
    };
    const auto measured = [](double StudyPoint::*member) {
      return
          [member](const Variant &variant, const std::size_t point) { return variant.points[point].*member; };
    };
    table(columns.value, "um", measured(&StudyPoint::response));
    const std::size_t n_parameters = frame.parameters.size();
    for (std::size_t p = 0; p < n_parameters; ++p)
      table("te_by_" + frame.parameters[p], "um over the key's unit",
            [&](const Variant &variant, const std::size_t point) {
              return variant.derivatives[point * n_parameters + p];
            });
    table(columns.value + std::string("_slope"), "um/" + slope_unit, measured(&StudyPoint::response_slope));
    table("max_pressure", "MPa", measured(&StudyPoint::max_pressure));
    table("edge_pressure", "MPa", measured(&StudyPoint::edge_pressure));
    table(columns.stiffness, "N/um", measured(&StudyPoint::stiffness));
  }

  void StudyTable::write_hdf5(const std::string &path, const CaseFile &file,
                              const std::vector<ResultTable> &tables, const std::string &versions) const
  {
    Hdf5File h5;
    write_head_of_study(h5, { file.source(), file.resolved(), axes_.text(), versions });
    // Variants over the same loads and positions stand in one block, whose numbers "variant" gives.
    std::vector<char> taken(variants_.size(), 0);
    int blocks = 0;
    for (std::size_t first = 0; first < variants_.size(); ++first)
      if (!taken[first] && variants_[first].failure.empty())
        {
          const std::vector<int> numbers = on_frame_of(first);
          for (const int v : numbers)
            taken[static_cast<std::size_t>(v)] = 1;
          write_block(h5, fmt::format("block_{}", blocks++), numbers);
        }
    for (const ResultTable &of_first : tables)
      of_first.write(h5);
    h5.write_to(path);
  }

  std::vector<std::string> StudyTable::failures(const BeyondTables &beyond) const
  {
    constexpr std::size_t most = 10;
    std::vector<std::string> lines;
    std::size_t all = 0;
    const auto add = [&](const auto &line) {
      if (++all <= most)
        lines.push_back(line());
    };
    for (std::size_t n = 0; n < variants_.size(); ++n)
      {
        const Variant &v = variants_[n];
        if (!v.failure.empty())
          add([&] { return fmt::format("variant {}: {}", n, v.failure); });
        for (const FailedLoad &failed : v.left_out)
          add([&] {
            return fmt::format("variant {}, {:.6g} {} has no results: {}", n, failed.load,
                               work_.columns().load_unit, failed.why);
          });
      }
    if (all > most)
      lines.push_back(fmt::format("{} more: column status of designs.csv", all - most));
    if (!beyond.failure.empty())
      lines.push_back("what was asked for beside the tables: " + beyond.failure);
    return lines;
  }

  std::string StudyTable::write(const ResultFolder &folder, const CaseFile &file, const BeyondTables &beyond,
                                const std::string &versions) const
  {
    folder.write("study.h5",
                 [&](const std::string &path) { write_hdf5(path, file, beyond.tables, versions); });
    for (const ResultTable &table : beyond.tables)
      table.write(folder);
    if (work_.columns().over_positions)
      folder.write("te.csv", [&](const std::string &path) { write_te(path); });
    folder.write("designs.csv", [&](const std::string &path) { write_designs(path, beyond.bounds); });
    folder.write("case.toml", file.source_with_settings());
    double worst = 0;
    for (const Variant &variant : variants_)
      for (const StudyPoint &p : variant.points)
        worst = std::max(worst, p.certificate);
    std::string summary = fmt::format(
        "{}\nstudy: {}, {} failed{}; certificate: worst relative violation {:.2e}\n", file.text("title"),
        counted(variants_.size(), "variant"), failed(),
        without_loads() > 0 ? fmt::format(", {} without some loads", without_loads()) : "", worst);
    for (const std::string &failure : failures(beyond))
      summary += "failed: " + failure + "\n";
    if (const long parts = without_period(); parts > 0 && work_.columns().over_positions)
      summary += fmt::format("warning: the positions of {} hold no whole period: no harmonics of these; "
                             "mean and peak-to-peak are of the computed positions alone\n",
                             counted(parts, "variant"));
    if (!beyond.summary.empty())
      summary += "of variant 0:\n" + beyond.summary;
    folder.write("summary.txt", summary);
    return summary;
  }
} // namespace flank
