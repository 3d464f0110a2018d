// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/study_axes.hpp"

#include "cases/case_file/printable.hpp"
#include "cases/case_file/value.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace flank
{
  StudyAxes::StudyAxes(const CaseFile &base)
      : base_(base)
  {
    for (StudyAxis &axis : read_axes(base))
      {
        if (!axis.file.empty())
          files_.push_back(axis.file);
        add(std::move(axis));
      }
    for (const StudyAxis &axis : axes_)
      if (std::none_of(axis.keys.begin(), axis.keys.end(), [&](const auto &key) { return varies(key); }))
        throw InputError(
            fmt::format("{}: {} changes nothing that is computed; a title stands beside the keys "
                        "that it names values of",
                        axis.where, fmt::join(axis.keys, ", ")));
    if (n_variants() > most_variants)
      throw InputError(fmt::format("{}: {} variants are more than 1e8; make the axes shorter",
                                   axes_.front().where, n_variants()));
    base_.forget_source();
    check_values();
    require_distinct_points();
  }

  bool StudyAxes::varies(const std::string &key) const
  {
    const Key *known = base_.schema().find(key);
    return key != "title" && !(known && known->type == Key::Type::text && known->choices.size() == 1);
  }

  void StudyAxes::add(StudyAxis axis)
  {
    const auto refuse = [&](const std::string &what) { throw InputError(axis.where + ": " + what); };
    for (const std::string &key : axis.keys)
      {
        if ((key == "output" || key.starts_with("output.")) && key != "output.derivatives")
          refuse(fmt::format("{} cannot vary in a study; flank run of one variant has it", shortened(key)));
        for (const std::string &other : keys_)
          if (CaseFile::overlap(key, other))
            refuse(fmt::format("{} is set by an axis before{}", shortened(key),
                               other == key ? "" : ", which sets " + shortened(other)));
        keys_.push_back(key);
      }
    if (!axis.together_with_previous)
      {
        axes_.push_back(std::move(axis));
        return;
      }
    if (axes_.empty() || axes_.back().points.size() != axis.points.size())
      refuse(axes_.empty() ? std::string("together_with_previous: there is none before it")
                           : fmt::format("together_with_previous: {} here, {} there",
                                         counted(axis.points.size(), "point"), axes_.back().points.size()));
    StudyAxis &before = axes_.back();
    before.is_range = before.is_range && axis.is_range;
    before.keys.insert(before.keys.end(), axis.keys.begin(), axis.keys.end());
    for (std::size_t k = 0; k < axis.points.size(); ++k)
      before.points[k].insert(before.points[k].end(), axis.points[k].begin(), axis.points[k].end());
  }

  void StudyAxes::check_values() const
  {
    for (const StudyAxis &axis : axes_)
      {
        std::vector<const Key *> keys;
        for (const std::string &key : axis.keys)
          keys.push_back(base_.schema().find(key));
        for (std::size_t p = 0; p < axis.points.size();
             p = axis.is_range && p == 1 ? std::max<std::size_t>(2, axis.points.size() - 1) : p + 1)
          {
            const std::vector<std::string> &point = axis.points[p];
            bool plain = p > 0; // keys are checked with the first point
            for (std::size_t k = 0; k < keys.size() && plain; ++k)
              plain = keys[k] && is_plainly_allowed(*keys[k], point[k]);
            if (plain)
              continue;
            std::vector<std::string> settings;
            for (std::size_t k = 0; k < keys.size(); ++k)
              settings.push_back(axis.keys[k] + "=" + point[k]);
            if (p == 0)
              base_.with(settings, axis.where);
            else
              base_.check(settings, axis.where);
          }
      }
  }

  /// What of an axis' points makes a difference: equal where numbers are.
  class StudyAxes::PointText
  {
  public:
    PointText(const std::vector<std::string> &keys, const StudyAxes &axes)
    {
      for (std::size_t k = 0; k < keys.size(); ++k)
        if (axes.varies(keys[k]))
          {
            const Key *key = axes.base_.schema().find(keys[k]);
            columns_.push_back({ k, key && key->type != Key::Type::text, keys[k].ends_with(".file") });
          }
    }

    std::string of(const std::vector<std::string> &point) const
    {
      std::string result;
      for (const Column &column : columns_)
        {
          const std::string &text = point[column.at];
          const auto numbers = column.is_number ? numbers_in(text) : std::nullopt;
          if (numbers)
            result.append(reinterpret_cast<const char *>(numbers->data()),
                          numbers->size() * sizeof numbers->front());
          else
            result += column.is_file ? file_in(text) : text;
          result += '\n';
        }
      return result;
    }

  private:
    /// The file that a text names, which can stand in quotation marks: "./a.csv" is a.csv.
    static std::string file_in(std::string_view text)
    {
      if (text.size() > 1 && text.starts_with('"') && text.ends_with('"'))
        text = text.substr(1, text.size() - 2);
      return std::filesystem::path(text).lexically_normal().string();
    }

    /// The numbers of a text, one or a list; a list of one is that one.
    static std::optional<std::vector<double>> numbers_in(std::string_view text)
    {
      if (text.starts_with("[") && text.ends_with("]"))
        text = text.substr(1, text.size() - 2);
      std::vector<double> numbers;
      for (std::size_t start = 0; start <= text.size();)
        {
          const std::size_t end = std::min(text.find(',', start), text.size());
          std::string_view part = text.substr(start, end - start);
          part.remove_prefix(std::min(part.find_first_not_of(' '), part.size()));
          part = part.substr(0, part.find_last_not_of(' ') + 1);
          const auto number = number_in(part);
          if (!number)
            return std::nullopt;
          numbers.push_back(*number + 0.0); // no minus zero
          start = end + 1;
        }
      return numbers;
    }

    struct Column
    {
      std::size_t at;
      bool is_number, is_file;
    };
    std::vector<Column> columns_;
  };

  void StudyAxes::require_distinct_points() const
  {
    const auto refuse = [](const StudyAxis &axis, const std::size_t one, const std::size_t other) {
      throw InputError(fmt::format("{}: points {} and {} are equal ({}): they would make equal variants; "
                                   "leave one out",
                                   axis.where, one + 1, other + 1,
                                   shortened(fmt::format("{}", fmt::join(axis.points[other], ", ")))));
    };
    for (const StudyAxis &axis : axes_)
      {
        const std::size_t n = axis.points.size();
        if (axis.is_range) // ascends or descends
          {
            for (std::size_t p = 1; p < n; ++p)
              if (axis.points[p] == axis.points[p - 1])
                refuse(axis, p - 1, p);
            continue;
          }
        const PointText compared(axis.keys, *this);
        std::vector<std::pair<std::size_t, std::size_t>> by_hash; // with the point
        by_hash.reserve(n);
        for (std::size_t p = 0; p < n; ++p)
          by_hash.emplace_back(std::hash<std::string>()(compared.of(axis.points[p])), p);
        std::sort(by_hash.begin(), by_hash.end());
        for (std::size_t p = 1; p < n; ++p)
          if (by_hash[p].first == by_hash[p - 1].first &&
              compared.of(axis.points[by_hash[p].second]) == compared.of(axis.points[by_hash[p - 1].second]))
            refuse(axis, by_hash[p - 1].second, by_hash[p].second);
      }
  }

  void StudyAxes::require_no_settings() const
  {
    for (const StudyAxis &axis : axes_)
      for (const std::string &key : axis.keys)
        if (const std::string setting = base_.setting_of(key); !setting.empty())
          throw InputError(fmt::format("{}: {} is set by {} too, which would have no effect; leave it out",
                                       axis.where, shortened(key), setting));
  }

  long StudyAxes::n_variants() const
  {
    double n = 1;
    for (const StudyAxis &axis : axes_)
      n *= static_cast<double>(axis.points.size());
    return n > 1e18 ? static_cast<long>(1e18) : std::lround(n);
  }

  std::vector<std::size_t> StudyAxes::point_of(long variant) const
  {
    std::vector<std::size_t> point(axes_.size());
    for (std::size_t a = axes_.size(); a-- > 0;)
      {
        const auto n = static_cast<long>(axes_[a].points.size());
        point[a] = static_cast<std::size_t>(variant % n);
        variant /= n;
      }
    return point;
  }

  std::vector<std::string> StudyAxes::values(const long variant) const
  {
    const auto point = point_of(variant);
    std::vector<std::string> result;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      result.insert(result.end(), axes_[a].points[point[a]].begin(), axes_[a].points[point[a]].end());
    return result;
  }

  double StudyAxes::letters() const
  {
    double sum = 0;
    for (const StudyAxis &axis : axes_)
      {
        double of_axis = 0;
        for (const auto &point : axis.points)
          for (const std::string &value : point)
            of_axis += static_cast<double>(value.size());
        sum += of_axis / static_cast<double>(axis.points.size()) * static_cast<double>(n_variants());
      }
    return sum;
  }

  std::vector<long> StudyAxes::shape() const
  {
    std::vector<long> result;
    for (const StudyAxis &axis : axes_)
      result.push_back(static_cast<long>(axis.points.size()));
    return result;
  }

  long StudyAxes::variant_on_axis(const std::size_t axis, const long point) const
  {
    long step = 1;
    for (std::size_t a = axis + 1; a < axes_.size(); ++a)
      step *= static_cast<long>(axes_[a].points.size());
    return point * step;
  }

  CaseFile StudyAxes::variant(const long number) const
  {
    std::vector<std::string> settings;
    const std::vector<std::string> own = values(number);
    for (std::size_t k = 0; k < keys_.size(); ++k)
      settings.push_back(keys_[k] + "=" + own[k]);
    return base_.with(settings, fmt::format("{} variant {}", base_.file(), number));
  }

  std::optional<std::vector<std::pair<std::string, double>>> StudyAxes::changes(const long variant,
                                                                                const long other) const
  {
    const auto point = point_of(variant), before = point_of(other);
    std::vector<std::pair<std::string, double>> result;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (point[a] != before[a])
        for (std::size_t k = 0; k < axes_[a].keys.size(); ++k)
          if (const std::string &value = axes_[a].points[point[a]][k]; value != axes_[a].points[before[a]][k])
            {
              const auto number = number_in(value);
              if (!number)
                return std::nullopt;
              result.emplace_back(axes_[a].keys[k], *number);
            }
    return result;
  }

  std::string StudyAxes::text() const
  {
    std::string result;
    for (const StudyAxis &axis : axes_)
      {
        result += fmt::format("study of {}:", fmt::join(axis.keys, ", "));
        for (const auto &point : axis.points)
          result += fmt::format(" ({})", fmt::join(point, ", "));
        result += "\n";
      }
    return result;
  }
} // namespace flank
