// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/study/study_axis.hpp"
#include "mesh/base/errors.hpp"

#include <algorithm>
#include <optional>

namespace flank
{
  /// The [[study]] tables of a case: axes whose values are combined with one another, the last one fastest.
  /// Points of an axis and their settings:
  ///   set = "key" or ["key", ...] with values = [...]: every key takes the value;
  ///   set = ["a", "b"] with rows = [[1, 2], [3, 4]]: a row a point, a value a key;
  ///   set with from, to, count, spacing = "linear" (default) or "logarithmic";
  ///   file = "designs.csv": keys in the first line, a row a point;
  ///   together_with_previous = true: goes along with the axis before it, which has as many points.
  class StudyAxes
  {
  public:
    /// Reads the axes from the case's own text. Throws InputError with file, line and what is allowed; so
    /// does a value that the schema refuses.
    explicit StudyAxes(const CaseFile &base);

    /// Throws InputError where the command line sets a key that an axis sets.
    void require_no_settings() const;

    long n_variants() const;

    /// The keys that the axes set, in the order of the axes.
    const std::vector<std::string> &keys() const { return keys_; }

    /// Values of keys() in a variant, as given.
    std::vector<std::string> values(long variant) const;

    CaseFile variant(long number) const;

    /// The keys that `variant` sets otherwise than `other`, with its values, where all of them are numbers.
    std::optional<std::vector<std::pair<std::string, double>>> changes(long variant, long other) const;

    /// read(case) of the first variant that it does not refuse, among the first thousand; nothing if it
    /// refuses them all.
    template <class Read>
    auto of_first_taken(const Read &read) const -> std::optional<decltype(read(variant(0)))>
    {
      for (long v = 0; v < std::min(n_variants(), 1000L); ++v)
        try
          {
            return read(variant(v));
          }
        catch (const InputError &)
          {
          }
      return std::nullopt;
    }

    /// Everything the variants depend on besides the case's keys, line by line.
    std::string text() const;

    /// The files that axes are read from.
    const std::vector<std::string> &files() const { return files_; }

    /// How many letters the values of all variants have together: how much there is to read when every
    /// variant is looked at.
    double letters() const;

    /// Numbers of points on the axes, the last one fastest.
    std::vector<long> shape() const;

    /// The variant whose place on axis `axis` is `point`, and on the others that of the first variant.
    long variant_on_axis(std::size_t axis, long point) const;

    static constexpr long most_variants = 100'000'000;

  private:
    class PointText;
    void add(StudyAxis axis);

    /// Whether values of this key can make a difference to what is computed.
    bool varies(const std::string &key) const;

    /// Checks every value against the schema, one axis at a time; of a range the ends and one value between
    /// them, which tells whether all are integers. Throws InputError.
    void check_values() const;

    /// Throws InputError where two points of an axis would make equal variants.
    void require_distinct_points() const;

    std::vector<std::size_t> point_of(long variant) const; ///< numbers of its points on all axes

    CaseFile base_;
    std::vector<StudyAxis> axes_;
    std::vector<std::string> keys_, files_;
  };
} // namespace flank
