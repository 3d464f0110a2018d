// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/value.hpp"

#include "cases/case_file/case_file.hpp"
#include "cases/case_file/printable.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// One key's value.
    class ValueReader
    {
    public:
      ValueReader(const Key &key, const toml::node &node, const std::string &place)
          : key_(key)
          , node_(node)
          , place_(place)
      {
      }

      Value read() const
      {
        switch (key_.type)
          {
          case Key::Type::text:
            return text();
          case Key::Type::texts:
            return texts();
          case Key::Type::integer:
            return integer();
          case Key::Type::number:
            return number(node_, "not a number");
          case Key::Type::numbers:
            break;
          }
        return numbers();
      }

    private:
      [[noreturn]] void refuse(const std::string &what) const
      {
        throw InputError(
            fmt::format("{} = {}: {}, allowed is {}", place_, shown_value(node_), what, key_.allowed()));
      }

      bool is_choice(const std::string &value) const
      {
        return std::find(key_.choices.begin(), key_.choices.end(), value) != key_.choices.end();
      }

      double within_bounds(const double value) const
      {
        if (!std::isfinite(value))
          refuse("not a finite number");
        if (value < key_.low || value > key_.high || (key_.low_open && value == key_.low))
          refuse("out of bounds");
        return value;
      }

      const toml::array &list(const char *what) const
      {
        const toml::array *array = node_.as_array();
        if (!array)
          refuse(what);
        if (array->size() > CaseFile::most_numbers)
          refuse(fmt::format("{} entries, at most {} are read", array->size(), CaseFile::most_numbers));
        return *array;
      }

      std::string text() const
      {
        if (!node_.is_string())
          refuse("not a text");
        const std::string value = node_.as_string()->get();
        if (value.size() > CaseFile::most_letters)
          refuse(fmt::format("{} letters, at most {} are read", value.size(), CaseFile::most_letters));
        if (value.find('\t') != std::string::npos || printable_line(value) != value)
          refuse("holds control characters");
        if (!key_.choices.empty() && !is_choice(value))
          refuse("unknown choice");
        return value;
      }

      std::vector<std::string> texts() const
      {
        std::vector<std::string> values;
        for (const toml::node &item : list("not a list of texts"))
          {
            if (!item.is_string() || !is_choice(item.as_string()->get()))
              refuse("unknown choice");
            values.push_back(item.as_string()->get());
          }
        return values;
      }

      long integer() const
      {
        if (!node_.is_integer())
          refuse("not an integer");
        within_bounds(static_cast<double>(node_.as_integer()->get()));
        return static_cast<long>(node_.as_integer()->get());
      }

      double number(const toml::node &node, const char *what) const
      {
        if (!node.is_number())
          refuse(what);
        return within_bounds(toml_number(node));
      }

      /// One number stands for a list of one.
      std::vector<double> numbers() const
      {
        if (node_.is_number())
          return { number(node_, "") };
        std::vector<double> values;
        for (const toml::node &item : list("not a list of numbers"))
          values.push_back(number(item, "not a list of numbers"));
        if (values.empty())
          refuse("an empty list");
        return values;
      }

      const Key &key_;
      const toml::node &node_;
      const std::string &place_;
    };
  } // namespace

  Value value_of(const Key &key, const toml::node &node, const std::string &place)
  {
    return ValueReader(key, node, place).read();
  }

  std::string shown_value(const toml::node &node)
  {
    std::string text = printable_line(toml_text(node));
    std::replace(text.begin(), text.end(), '\t', ' ');
    return text.size() > 80 ? text.substr(0, 80) + "..." : text;
  }
} // namespace flank
