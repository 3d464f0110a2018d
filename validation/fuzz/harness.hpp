// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/schema.hpp"
#include "mesh/base/errors.hpp"

#include <string>
#include <string_view>

namespace flank::fuzz
{
  /// The keys of the scenes whose cases are read.
  const Schema &schema();

  /// Each gives bytes to one reader, as a file or a command line may hold them, goes on with what was read,
  /// and says in the reader's words why it was refused; nothing: it was taken. Whatever else it throws is a
  /// mistake of the reader.
  std::string take_case(std::string_view bytes);       ///< a whole case file; of a study some variants
  std::string take_setting(std::string_view bytes);    ///< one --set of a ready case; first letter: d of a
                                                       ///< double-roller drive, else of gears
  std::string take_axes(std::string_view bytes);       ///< [[study]] tables; after a line "---" the file of
                                                       ///< designs, which is called "200"
  std::string take_topography(std::string_view bytes); ///< a table of removed material
  std::string take_lcp(std::string_view bytes);        ///< a contact problem; few cells: solved
  std::string take_journal(
      std::string_view bytes); ///< after a first letter a journal; letter "m": its checksums are mended first
  std::string take_operator(std::string_view bytes); ///< a letter; "f": the file of a cache, "c", else: an
                                                     ///< operator, classical or projected
  std::string take_manifest(std::string_view bytes); ///< of a folder of results

  /// The words that `use` refuses with; nothing: it does not.
  template <class Use>
  std::string refusal_of(const Use &use)
  {
    try
      {
        use();
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    catch (const OutputError &error)
      {
        return error.what();
      }
    catch (const UnusableRecord &error)
      {
        return error.what();
      }
    return "";
  }

  /// Throws std::logic_error.
  void require(bool holds, const char *what);

  /// A regular file in memory, with a path.
  class MemoryFile
  {
  public:
    explicit MemoryFile(int descriptor);
    void set(std::string_view content) const;

    /// A file name in its folder; as text of a key it stands for this file.
    static const std::string &beside();

  private:
    int descriptor_;
  };

  /// A fresh folder of this process, in memory where that can be; removed at its end.
  const std::string &folder();

  /// No words from the log.
  void be_quiet();

  /// Text of a file of the tree.
  std::string content(const std::string &path_from_root);
} // namespace flank::fuzz
