// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/value.hpp"

#include "cases/case_file/case_file.hpp"
#include "cases/case_file/printable.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace flank
{
  namespace
  {
    bool within_bounds(const Key &key, const double value)
    {
      return value >= key.low && value <= key.high && !(key.low_open && value == key.low);
    }

    /// Digits from a place on: where they end.
    std::size_t end_of_digits(const std::string_view text, const std::size_t at)
    {
      return std::min(text.size(), text.find_first_not_of("0123456789", at));
    }

    /// -12, 0.5, 1e-3: what TOML and from_chars read alike; integers that surely fit 64 bits.
    bool is_plain_number(const std::string_view text, const bool whole)
    {
      const std::size_t begin = text.starts_with('-') ? 1 : 0;
      std::size_t at = end_of_digits(text, begin);
      if (at == begin || at - begin > 18 || (text[begin] == '0' && at - begin > 1))
        return false;
      if (whole)
        return at == text.size();
      if (at < text.size() && text[at] == '.')
        {
          const std::size_t decimals = at + 1;
          at = end_of_digits(text, decimals);
          if (at == decimals)
            return false;
        }
      if (at < text.size() && (text[at] == 'e' || text[at] == 'E'))
        {
          const bool sign = at + 1 < text.size() && (text[at + 1] == '-' || text[at + 1] == '+');
          const std::size_t exponent = at + 1 + sign;
          at = end_of_digits(text, exponent);
          if (at == exponent)
            return false;
        }
      return at == text.size();
    }

    /// Letters that mean nothing else in TOML, in quotes or without.
    bool is_plain_text(const Key &key, std::string_view text)
    {
      if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
        text = text.substr(1, text.size() - 2);
      const auto is_plain = [](const char c) {
        return c >= ' ' && c <= '~' && std::string_view("\"'\\{").find(c) == std::string_view::npos;
      };
      return std::all_of(text.begin(), text.end(), is_plain) &&
             (key.choices.empty() ||
              std::find(key.choices.begin(), key.choices.end(), text) != key.choices.end());
    }

    /// Reads the value of one key.
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

      double bounded(const double value) const
      {
        if (!std::isfinite(value))
          refuse("not a finite number");
        if (!within_bounds(key_, value))
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
        bounded(static_cast<double>(node_.as_integer()->get()));
        return static_cast<long>(node_.as_integer()->get());
      }

      double number(const toml::node &node, const char *what) const
      {
        if (!node.is_number())
          refuse(what);
        return bounded(toml_number(node));
      }

      /// Reads a list of numbers; a single number stands for a list of one.
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

  std::optional<double> number_in(const std::string_view text)
  {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
  }

  bool is_plainly_allowed(const Key &key, std::string_view text)
  {
    constexpr std::size_t most = 200, most_of_list = CaseFile::most_setting_bytes / 2; // letters
    const auto is_number = [&](const std::string_view number) {
      const bool plain = number.size() <= most && is_plain_number(number, key.type == Key::Type::integer);
      const auto value = plain ? number_in(number) : std::nullopt;
      return value && within_bounds(key, *value);
    };
    if (key.type == Key::Type::texts || text.size() > most_of_list)
      return false;
    if (key.type == Key::Type::text)
      return text.size() <= most && is_plain_text(key, text);
    if (key.type != Key::Type::numbers || !text.starts_with("[ ") || !text.ends_with(" ]"))
      return is_number(text);
    text = text.substr(2, text.size() - 4); // as toml_text() writes it
    for (std::size_t n = 1; n <= CaseFile::most_numbers; ++n)
      {
        const auto comma = text.find(", ");
        if (!is_number(text.substr(0, comma)))
          return false;
        if (comma == std::string_view::npos)
          return true;
        text.remove_prefix(comma + 2);
      }
    return false;
  }

  std::string shown_value(const toml::node &node)
  {
    std::string text = printable_line(toml_text(node));
    std::replace(text.begin(), text.end(), '\t', ' ');
    return text.size() > 80 ? text.substr(0, 80) + "..." : text;
  }
} // namespace flank
