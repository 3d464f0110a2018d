// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace flank
{
  /// Numbers and matrices one after the other, as they are in memory.
  class Packer
  {
  public:
    template <class Number>
    void number(const Number &value)
    {
      static_assert(std::is_arithmetic_v<Number>);
      bytes(&value, sizeof value);
    }
    void numbers(const std::vector<double> &values) { all(values); }
    void matrix(const Eigen::MatrixXd &value)
    {
      number(static_cast<std::int64_t>(value.rows()));
      number(static_cast<std::int64_t>(value.cols()));
      bytes(value.data(), value.size() * sizeof(double));
    }

    /// Elements that are plain numbers throughout.
    template <class Element>
    void all(const std::vector<Element> &values)
    {
      static_assert(std::is_trivially_copyable_v<Element>);
      number(static_cast<std::int64_t>(values.size()));
      bytes(values.data(), values.size() * sizeof(Element));
    }

    /// One plain value.
    template <class Plain>
    void plain(const Plain &value)
    {
      static_assert(std::is_trivially_copyable_v<Plain>);
      bytes(&value, sizeof value);
    }

    std::vector<char> result;

  private:
    void bytes(const void *from, const std::size_t count)
    {
      result.insert(result.end(), static_cast<const char *>(from), static_cast<const char *>(from) + count);
    }
  };

  /// Reads what Packer wrote; running off the end is our own mistake, because checksums come first.
  class Unpacker
  {
  public:
    explicit Unpacker(const std::vector<char> &from)
        : from_(from)
    {
    }
    template <class Number>
    Number number()
    {
      Number value;
      bytes(&value, sizeof value);
      return value;
    }
    std::vector<double> numbers() { return all<double>(); }
    Eigen::MatrixXd     matrix()
    {
      const auto      rows = number<std::int64_t>(), cols = number<std::int64_t>();
      Eigen::MatrixXd value(rows, cols);
      bytes(value.data(), value.size() * sizeof(double));
      return value;
    }
    template <class Element>
    std::vector<Element> all()
    {
      std::vector<Element> values(number<std::int64_t>());
      bytes(values.data(), values.size() * sizeof(Element));
      return values;
    }
    template <class Plain>
    Plain plain()
    {
      Plain value;
      bytes(&value, sizeof value);
      return value;
    }
    bool at_end() const { return at_ == from_.size(); }

  private:
    void bytes(void *to, const std::size_t count)
    {
      if (count > from_.size() - at_)
        throw std::logic_error("a packed record ends early");
      if (count > 0)
        std::memcpy(to, from_.data() + at_, count);
      at_ += count;
    }
    const std::vector<char> &from_;
    std::size_t              at_ = 0;
  };
} // namespace flank
