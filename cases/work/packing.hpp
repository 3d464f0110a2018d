// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/errors.hpp"
#include "mesh/base/shared_memory.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace flank
{
  /// Whether a field is a matrix, whose columns are no single list.
  template <class Field>
  concept is_matrix = requires
  {
    requires Field::ColsAtCompileTime != 1;
  };

  /// Numbers and matrices one after the other, as they are in memory. A record has one list of its fields,
  /// written for an Archive that is a Packer or an Unpacker.
  class Packer
  {
  public:
    /// Fields of any kind: plain values, texts, lists of plain values, vectors and matrices.
    template <class... Fields>
    void fields(const Fields &...all)
    {
      (field(all), ...);
    }

    /// Writes the number of entries, then what each(*this, entry) packs of every one, which must be at least
    /// a byte.
    template <class List, class Each>
    void list(const List &entries, const Each &each)
    {
      value(static_cast<int>(entries.size()));
      for (const auto &entry : entries)
        each(*this, entry);
    }

    /// One plain value: a number, or a struct of numbers.
    template <class Plain>
    void value(const Plain &plain)
    {
      static_assert(std::is_trivially_copyable_v<Plain>);
      bytes(&plain, sizeof plain);
    }

    /// Writes the number of values, then the values, which are plain ones: of a list, a text or a vector.
    template <class List>
    void values(const List &list)
    {
      static_assert(std::is_trivially_copyable_v<typename List::value_type>);
      value(static_cast<std::int64_t>(list.size()));
      bytes(list.data(), static_cast<std::size_t>(list.size()) * sizeof(typename List::value_type));
    }

    /// Writes rows, columns and entries. The entries start at a multiple of 64 bytes, so that they can be
    /// used where they are.
    void matrix(const Eigen::Ref<const Eigen::MatrixXd> &entries)
    {
      value(static_cast<std::int64_t>(entries.rows()));
      value(static_cast<std::int64_t>(entries.cols()));
      result.resize((result.size() + 63) / 64 * 64);
      for (Eigen::Index j = 0; j < entries.cols(); ++j)
        bytes(entries.col(j).data(), entries.rows() * sizeof(double));
    }

    std::vector<char> result;

  private:
    template <class Field>
    void field(const Field &field)
    {
      if constexpr (std::is_same_v<Field, bool>)
        value(static_cast<unsigned char>(field));
      else if constexpr (std::is_trivially_copyable_v<Field>)
        value(field);
      else if constexpr (is_matrix<Field>)
        matrix(field);
      else
        values(field);
    }
    void bytes(const void *from, const std::size_t count)
    {
      if (count > 0)
        result.insert(result.end(), static_cast<const char *>(from), static_cast<const char *>(from) + count);
    }
  };

  /// Reads what Packer wrote. Trusts nothing: counts are bounded by the bytes that are left; throws
  /// UnusableRecord.
  class Unpacker
  {
  public:
    /// Bytes that outlive this; matrices are copied.
    explicit Unpacker(const std::vector<char> &from)
        : from_({ nullptr, from.data(), from.size() })
    {
    }
    /// Matrices stay where they are and keep the bytes alive.
    explicit Unpacker(SharedBytes from)
        : from_(std::move(from))
    {
    }
    /// What Packer::fields() wrote of them.
    template <class... Fields>
    void fields(Fields &...all)
    {
      (field(all), ...);
    }

    /// What Packer::list() wrote: each(*this, entry) reads one.
    template <class List, class Each>
    void list(List &entries, const Each &each)
    {
      auto left = value<int>();
      if (left < 0)
        throw UnusableRecord(fmt::format("{} entries", left));
      for (entries.clear(); left > 0; --left) // grows as they are read: a wrong number finds no bytes
        each(*this, entries.emplace_back());
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
      std::vector<Plain> list(count(sizeof(Plain)));
      bytes(list.data(), list.size() * sizeof(Plain));
      return list;
    }
    SharedMatrix matrix()
    {
      const auto rows = value<std::int64_t>(), cols = value<std::int64_t>();
      skip((at_ + 63) / 64 * 64 - at_);
      const auto most = static_cast<std::int64_t>((from_.size - at_) / sizeof(double));
      if (rows < 0 || cols < 0 || (rows > 0 && cols > most / rows))
        throw UnusableRecord(
            fmt::format("a matrix of {} x {} numbers in {} bytes", rows, cols, from_.size - at_));
      const auto *entries = reinterpret_cast<const double *>(from_.data + at_);
      skip(static_cast<std::size_t>(rows * cols) * sizeof(double));
      if (from_.memory)
        return { from_.memory, entries, rows, cols };
      return Eigen::MatrixXd(Eigen::Map<const Eigen::MatrixXd>(entries, rows, cols));
    }
    bool at_end() const { return at_ == from_.size; }

    /// The number of things that follow, each of which takes at least `each` bytes.
    std::size_t count(const std::size_t each)
    {
      const auto n = value<std::int64_t>();
      if (n < 0 || static_cast<std::uint64_t>(n) > (from_.size - at_) / each)
        throw UnusableRecord(fmt::format("{} entries in {} bytes", n, from_.size - at_));
      return static_cast<std::size_t>(n);
    }

  private:
    template <class Field>
    void field(Field &field)
    {
      if constexpr (std::is_same_v<Field, bool>)
        field = value<unsigned char>() != 0;
      else if constexpr (std::is_trivially_copyable_v<Field>)
        field = value<Field>();
      else if constexpr (is_matrix<Field>)
        {
          const SharedMatrix read = matrix();
          if (Field::RowsAtCompileTime != Eigen::Dynamic && read.rows() != Field::RowsAtCompileTime)
            throw UnusableRecord(fmt::format("a matrix of {} rows", read.rows()));
          field = read;
        }
      else
        {
          using Plain = typename Field::value_type;
          const std::size_t n = count(sizeof(Plain));
          field.resize(static_cast<decltype(field.size())>(n));
          bytes(field.data(), n * sizeof(Plain));
        }
    }
    void skip(const std::size_t count)
    {
      if (count > from_.size - at_)
        throw UnusableRecord("it ends early");
      at_ += count;
    }
    void bytes(void *to, const std::size_t count)
    {
      const char *start = from_.data + at_;
      skip(count);
      if (count > 0)
        std::memcpy(to, start, count);
    }
    SharedBytes from_;
    std::size_t at_ = 0;
  };
} // namespace flank
