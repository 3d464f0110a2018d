// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/manifest.hpp"

#include <fmt/format.h>

#include <charconv>
#include <set>
#include <sstream>

namespace flank
{
  namespace
  {
    constexpr const char *head =
        "Flank results, format 1. Only the files listed here are ever replaced or removed by Flank.";
    constexpr std::uint64_t most = 256u << 20; ///< bytes of a manifest
    const std::string failed = "failed: ";

    /// A path that stays inside the folder: no root, no step up, nothing a line cannot hold.
    bool is_inside(const std::string &path)
    {
      if (path.empty() || path.front() == '/' || path == Manifest::name)
        return false;
      std::istringstream parts(path);
      for (std::string part; std::getline(parts, part, '/');)
        if (part.empty() || part == "." || part == "..")
          return false;
      return true;
    }

    /// The rest of a line that begins with `name`.
    std::optional<std::string> value_of(std::istream &stream, const std::string &name)
    {
      std::string line;
      if (!std::getline(stream, line) || !line.starts_with(name))
        return std::nullopt;
      return line.substr(name.size());
    }

    template <class Number>
    bool read_number(const std::string &text, const int base, Number &number)
    {
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
      return error == std::errc() && end == text.data() + text.size();
    }
  } // namespace

  std::string Manifest::text() const
  {
    std::string result =
        fmt::format("{}\nprogram: {}\ncommand: {}\nfiles: {}\n", head, program, command, files.size());
    for (const auto &[path, fingerprint] : files)
      result += fmt::format("{:08x} {} {}\n", fingerprint.crc, fingerprint.size, path);
    for (const std::string &failure : failures)
      result += failed + failure + "\n";
    return result + "case:\n" + inputs;
  }

  std::optional<Manifest> Manifest::parse(const std::string &text)
  {
    std::istringstream stream(text);
    Manifest result;
    std::size_t count = 0;
    const auto format = value_of(stream, head);
    const auto program = value_of(stream, "program: "), command = value_of(stream, "command: "),
               files = value_of(stream, "files: ");
    if (!format || !program || !command || !files || !read_number(*files, 10, count))
      return std::nullopt;
    result.program = *program;
    result.command = *command;
    std::string line;
    for (std::size_t k = 0; k < count; ++k)
      {
        std::string crc, size, path;
        Fingerprint fingerprint;
        if (!std::getline(stream, line))
          return std::nullopt;
        std::istringstream words(line);
        if (!(words >> crc >> size) || !std::getline(words >> std::ws, path) ||
            !read_number(crc, 16, fingerprint.crc) || !read_number(size, 10, fingerprint.size) ||
            !is_inside(path))
          return std::nullopt;
        result.files.emplace(path, fingerprint);
      }
    while (std::getline(stream, line) && line.starts_with(failed))
      result.failures.push_back(line.substr(failed.size()));
    if (line != "case:")
      return std::nullopt;
    const auto at = stream.tellg();
    result.inputs = at < 0 ? "" : text.substr(static_cast<std::size_t>(at));
    return result;
  }

  std::optional<Manifest> Manifest::read(const std::string &path)
  {
    try
      {
        return parse(content_of(path, most));
      }
    catch (const std::runtime_error &)
      {
        return std::nullopt;
      }
  }

  std::string first_difference(const std::string &there, const std::string &now)
  {
    const auto lines = [](const std::string &text) {
      std::set<std::string> result;
      for (std::size_t at = 0; at < text.size();)
        {
          const auto end = std::min(text.find('\n', at), text.size());
          result.insert(text.substr(at, end - at));
          at = end + 1;
        }
      return result;
    };
    const auto a = lines(there), b = lines(now);
    const auto only = [](const std::set<std::string> &in, const std::set<std::string> &other) -> std::string {
      for (const std::string &line : in)
        if (!other.contains(line))
          return line.size() > 200 ? line.substr(0, 200) + "..." : line;
      return "(left out)";
    };
    return fmt::format("\"{}\" there, \"{}\" now", only(a, b), only(b, a));
  }
} // namespace flank
