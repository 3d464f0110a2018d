// SPDX-License-Identifier: GPL-2.0-or-later
// fuzz_seeds FOLDER: writes what the harnesses start from and no file of the tree says: a dictionary of the
// schema's words, and binary inputs in today's formats.
#include "validation/fuzz/harness.hpp"
#include "validation/fuzz/operator.hpp"

#include "cases/parallel_axis/pair/position_record.hpp"
#include "cases/work/journal.hpp"
#include "cases/work/operator_cache.hpp"
#include "cases/work/packing.hpp"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

using namespace flank;

namespace
{
  void write(const std::string &file, const std::string &bytes)
  {
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
  }

  std::string text(const std::vector<char> &bytes)
  {
    return { bytes.begin(), bytes.end() };
  }

  std::string read(const std::string &file)
  {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
  }

  /// Whole keys, their parts and choices; what TOML has besides.
  std::string dictionary()
  {
    std::set<std::string> words = { "[[study]]",
                                    "[pinion]",
                                    "[gear]",
                                    "[drive]",
                                    "set = ",
                                    "values = [",
                                    "rows = [[",
                                    "from = ",
                                    "to = ",
                                    "count = ",
                                    "spacing = ",
                                    "logarithmic",
                                    "file = ",
                                    "together_with_previous = true",
                                    "\\\"\\\"\\\"",
                                    "'''",
                                    "inf",
                                    "nan",
                                    "1e308",
                                    "1e-308",
                                    "-0.0",
                                    "0x7fffffffffffffff",
                                    "1979-05-27",
                                    "[1].",
                                    "[99].",
                                    "{}",
                                    "[]",
                                    "\\x0a",
                                    "\\xef\\xbb\\xbf" };
    for (const Key &key : fuzz::schema().keys())
      if (key.listed)
        {
          words.insert(key.path);
          std::istringstream parts(key.path);
          for (std::string part; std::getline(parts, part, '.');)
            words.insert(part);
          words.insert(key.choices.begin(), key.choices.end());
        }
    std::string result;
    for (const std::string &word : words)
      result += "\"" + word + "\"\n";
    return result;
  }

  std::string band(const std::vector<double> &torques, const double phase, const int cycles)
  {
    Packer out;
    for (int cycle = 0; cycle < cycles; ++cycle)
      {
        std::vector<PositionResult> results(torques.size());
        const auto cells = std::make_shared<const std::vector<GridCell>>(
            2, GridCell{ 0, 1.5, 0.4, 0.4, 0.01, 0.001, CellPlace::inside });
        for (std::size_t t = 0; t < torques.size(); ++t)
          {
            results[t].torque = torques[t];
            results[t].phase = phase + cycle;
            results[t].certificate.gate = 1e-10;
            results[t].pairs = { { 0, 100, 500 } };
            results[t].lines = { { 0, 1.5, 0.4, 10, 500, 0.1, 0.5 } };
            results[t].cell_forces = { 60, 40 };
            results[t].grid_cells = cells;
          }
        pack(results, out);
      }
    return text(out.result);
  }
} // namespace

int main(int, char **arguments)
{
  const std::string to = arguments[1], &folder = fuzz::folder();
  write(to + "/words.dict", dictionary());
  const auto bytes_of = [](const std::string &content) {
    return std::vector<char>(content.begin(), content.end());
  };
  {
    Journal journal(folder, "key");
    journal.append("a", bytes_of(band({ 1000, 500 }, 0.25, 2)));
    journal.append("b", bytes_of(band({ 0 }, 0.25, 1)));
  }
  const std::string journal = read(folder + "/positions-0-1.journal");
  write(to + "/journal/mended", "m" + journal);
  write(to + "/journal/as_it_is", "-" + journal);
  write(to + "/operator/projected", "p" + text(fuzz::small_operator(Split::projected)));
  write(to + "/operator/classical", "c" + text(fuzz::small_operator(Split::classical)));
  const OperatorCache cache(folder);
  cache.store("key", fuzz::small_operator(Split::projected));
  write(to + "/operator/file", "f" + read(cache.path("key")));
  for (const char *name :
       { "journal/mended", "journal/as_it_is", "operator/projected", "operator/classical", "operator/file" })
    {
      const bool is_journal = std::string(name).starts_with("journal");
      const std::string words =
          (is_journal ? fuzz::take_journal : fuzz::take_operator)(read(to + "/" + name));
      fuzz::require(words.empty(), (std::string(name) + " is refused: " + words).c_str());
    }
}
