// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/named_files.hpp"
#include "cases/case_file/schema.hpp"
#include "mesh/base/errors.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace flank
{
  /// A case as given: every key checked against the schema. The only place that knows the file format.
  class CaseFile
  {
  public:
    /// Reads a file and applies `settings` ("key=value", value as in the file, quotes around texts may be
    /// left out). Throws InputError with file, line, key, value and what is allowed; of a file that is no
    /// case nothing is shown. `schema` stays in use.
    static CaseFile read(const Schema &schema, const std::string &file,
                         const std::vector<std::string> &settings = {});

    /// The same of a text, as if it stood in `file`.
    static CaseFile of_text(const Schema &schema, std::string content, const std::string &file,
                            const std::vector<std::string> &settings = {});

    /// Bounds of what is read. [bytes, letters, entries]
    static constexpr std::size_t most_bytes = 16u << 20, most_setting_bytes = 1u << 20,
                                 most_table_bytes = 64u << 20;
    static constexpr std::size_t most_letters = 4096, most_key_letters = 256, most_numbers = 100'000;
    static constexpr int most_tables = 64; ///< in a list of tables

    /// The same case with further settings; `where` stands before what is said about them.
    CaseFile with(const std::vector<std::string> &settings, const std::string &where) const;

    /// Settings against the schema alone: keys, types and bounds. Throws InputError.
    void check(const std::vector<std::string> &settings, const std::string &where) const;

    const Schema &schema() const { return *schema_; }

    /// Has [[study]] axes (read by StudyAxes; to everything else they are not there).
    bool has_study() const { return has_study_; }

    /// Checks that a case has [[study]] axes, for a key whose value only a study can have; `why`: a sentence
    /// about it. Throws InputError, which names the key and its place, where it has none.
    void require_study(const std::string &key, const std::string &why) const;

    /// The setting of the command line that gives this key, a part of it or what it is a part of; empty: none
    /// does.
    std::string setting_of(const std::string &path) const;

    /// Whether two paths are the same, or one is a table that holds the other.
    static bool overlap(const std::string &one, const std::string &other);

    bool has(const std::string &path) const { return entries_.contains(path); }
    std::string text(const std::string &path) const; ///< or the schema's default
    double number(const std::string &path) const;    ///< or the schema's default if it is a number
    int integer(const std::string &path) const;
    std::vector<double> numbers(const std::string &path) const;
    std::vector<double> numbers_or_zero(
        const std::string &path,
        double least) const; ///< each 0 or at least `least`, none twice; else InputError
    std::vector<std::string> texts(const std::string &path) const; ///< none where left out
    bool has_any(const std::string &prefix) const;                 ///< a key that starts so
    bool copied(const std::string &path) const;                    ///< taken over by `like`
    int count(const std::string &list) const; ///< tables in a list, such as "pinion.bias"; numbered from 1
    std::vector<std::string> keys_ending_with(const std::string &end) const; ///< given ones

    /// Content of the file that a key names, from the case file's folder: as it was when this case or one
    /// that it was made from (with()) read it first. Throws InputError.
    const std::string &text_of_file(const std::string &path) const;

    /// The files that keys named, as far as this case or one made from the same text has read them, line by
    /// line: their names and checksums, or why they cannot be read.
    std::string files_read() const { return named_->digests(); }

    std::optional<double> optional_number(const std::string &path) const;

    /// "file:line: key = value: " of a given key, of a copied one with the key that was given, "file: key: "
    /// of a missing one.
    std::string place(const std::string &path) const;

    /// Calls read(). Its InputErrors get the place of the key by which the case gives the quantity that they
    /// are about. `keys`: the key of every quantity.
    template <class Read>
    auto with_places(const std::map<std::string, std::string> &keys, const Read &read) const
    try
      {
        return read();
      }
    catch (const InputError &error)
      {
        if (error.quantity.empty())
          throw;
        const auto key = keys.find(error.quantity);
        FLANK_ASSERT(key != keys.end(), error.quantity);
        throw InputError(place(key->second) + error.what());
      }

    /// Throws InputError if a key is given that nobody has asked for: it would do nothing. An object is for
    /// one thread.
    void require_all_used() const;

    /// The case file and all files that its keys name.
    std::vector<std::string> files() const;

    /// Everything that results depend on, line by line: resolved() and the contents of the files that keys
    /// name, by their checksums.
    std::string inputs() const;

    const std::string &file() const { return file_; }
    const std::string &source() const { return source_; }
    std::string source_with_settings() const; ///< the settings in a comment above it: for those who read it
    void forget_source() { source_.clear(); } ///< for what is copied many times

    /// All given keys with their values, one a line, in the schema's order; overridden ones included. What
    /// `like` copies is not there: the line of `like` says it, and a scene may read a copied value otherwise
    /// than a given one (mirrored).
    std::string resolved() const;

  private:
    struct Entry
    {
      std::variant<std::string, long, double, std::vector<double>, std::vector<std::string>> value;
      std::string shown, where;
      bool copied = false;
      mutable bool used = false;
    };
    explicit CaseFile(const Schema &schema)
        : schema_(&schema)
    {
    }
    class Reader;
    void copy(const CopyRule &rule);
    void erase_beginning(const std::string &start); ///< entries whose keys begin so
    void add_text(const std::string &toml, const std::string &name, const std::string &setting_where = {});
    void add_setting(const std::string &setting, const std::string &where);
    void finish();
    const Entry &required(const std::string &path) const;

    const Schema *schema_;
    std::string file_, source_;
    std::vector<std::string> settings_; ///< given beside the file
    bool has_study_ = false;
    std::shared_ptr<NamedFiles> named_ =
        std::make_shared<NamedFiles>();    ///< shared by all made from this case
    std::map<std::string, Entry> given_;   ///< without what `like` copies
    std::map<std::string, Entry> entries_; ///< with it
  };
} // namespace flank
