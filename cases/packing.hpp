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
    /// One plain value: a number, or a struct of numbers.
    template <class Plain>
    void value(const Plain &plain)
    {
      static_assert(std::is_trivially_copyable_v<Plain>);
      bytes(&plain, sizeof plain);
    }

    /// Their number, then the values, plain ones.
    template <class Plain>
    void values(const std::vector<Plain> &list)
    {
      static_assert(std::is_trivially_copyable_v<Plain>);
      value(static_cast<std::int64_t>(list.size()));
      bytes(list.data(), list.size() * sizeof(Plain));
    }

    void matrix(const Eigen::MatrixXd &entries)
    {
      value(static_cast<std::int64_t>(entries.rows()));
      value(static_cast<std::int64_t>(entries.cols()));
      bytes(entries.data(), entries.size() * sizeof(double));
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
    template <class Plain>
    Plain value()
    {
      Plain plain;
      bytes(&plain, sizeof plain);
      return plain;
    }
    template <class Plain>
    std::vector<Plain> values()
    {
      std::vector<Plain> list(value<std::int64_t>());
      bytes(list.data(), list.size() * sizeof(Plain));
      return list;
    }
    Eigen::MatrixXd matrix()
    {
      const auto      rows = value<std::int64_t>(), cols = value<std::int64_t>();
      Eigen::MatrixXd entries(rows, cols);
      bytes(entries.data(), entries.size() * sizeof(double));
      return entries;
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
