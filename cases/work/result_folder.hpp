// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/work/folder_lock.hpp"
#include "cases/work/manifest.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flank
{
  /// The folder a run writes into. What is being computed stands in its folder "unfinished"; results of an
  /// earlier run stay complete until the new ones are, and are then replaced file by file, in a way that a
  /// killed process can be gone on with. Files that the folder's manifest does not list are never touched.
  class ResultFolder
  {
  public:
    struct Request
    {
      std::string path;
      std::string command; ///< "run" or "study"
      std::string program; ///< its revision, for the manifest
      bool force = false;  ///< write beside files that are no results, and in place of other results
      bool resume = false; ///< go on with what a killed run of the same inputs left
      std::string part;    ///< of a study that several calls share: "2-of-8"; empty: the whole

      std::vector<std::string> names; ///< of all files that a run or study may write, but for those in the
                                      ///< folders fields and figures
    };

    /// Refuses (InputError) a path that is none, or cannot be written. Changes nothing.
    explicit ResultFolder(Request request);

    enum class Start
    {
      begun,
      finished ///< resume or part: the folder holds these very results, there is nothing to do
    };

    /// Takes the folder for this process, on one rank. `inputs`: everything the results depend on, line by
    /// line; `input_files`: that the run reads. Refuses (InputError), having changed nothing: a folder that
    /// another process works in; one that holds other files or other results, unless forced; inputs that are
    /// results of it; names of results that are somebody's own files.
    Start begin(const std::string &inputs, const std::vector<std::string> &input_files);

    /// Writes a new result, which stands under its name from finish() on. Throws OutputError; so does
    /// finish(), and both change nothing, where the folder was moved, removed or taken by somebody else since
    /// begin().
    void write(const std::string &name, const std::string &content) const;
    void write(const std::string &name, const std::function<void(const std::string &path)> &writer) const;

    /// Puts all that was written in the place of what was there, and gives the folder back. `failures`: what
    /// was asked for and could not be computed, a line each; the results are finished without it. On the rank
    /// that began. Throws OutputError.
    void finish(const std::vector<std::string> &failures = {});

    /// What the finished results in the folder are without, as finish() was told, a line each. Throws
    /// InputError where the folder's manifest is damaged.
    std::vector<std::string> failures() const { return listed().failures; }

    /// Removes what is unfinished, after a failure that would come again; of a part of a study nothing,
    /// because other parts may be at work.
    void discard();

    /// Who holds the folder since begin(), for the other processes of the run: they follow() it.
    const std::string &owner() const { return owner_; }
    void follow(std::string owner) { owner_ = std::move(owner); }

    /// Throws OutputError where the folder is no longer what begin() took: moved, removed, or taken over.
    void require_not_lost() const;

    /// Path of the folder in which journals stand while the run lasts.
    std::string work() const;

    const std::string &path() const { return request_.path; }

  private:
    bool is_result_name(const std::string &name) const;
    Manifest listed() const;
    std::optional<Manifest> ready() const;
    void require_own_names(const Manifest &old) const;
    void require_own_subfolder(const std::string &name, bool is_folder, const Manifest &old) const;
    void require_no_inputs(const Manifest &old, const std::vector<std::string> &input_files) const;
    void require_same(const Manifest &old, const std::string &inputs) const;

    struct Held
    {
      bool these;          ///< finished results of the inputs, all of them there
      std::string missing; ///< of these inputs, but this file is gone
    };

    /// What the folder holds of these inputs. Throws InputError where its results are others that may not be
    /// replaced, or where somebody's own files stand in the way.
    Held held(const std::string &inputs, const std::vector<std::string> &input_files) const;

    /// Takes the folder for this process. Throws InputError where another one has it.
    void lock(bool is_part);

    std::string lock_name() const;
    bool is_lost() const; ///< whether the folder is no longer what begin() took

    /// Removes all that is unfinished and gives the folder back.
    void clear_away();

    /// Removes the folders that were made for the results, as far as they are empty.
    void remove_made() const;

    /// Makes the folder of the user's choice. Throws InputError where it cannot be made.
    void require_possible(const std::string &path) const;
    void make_work_folder(const std::string &inputs) const;
    void clear_work_folder(bool journals) const;
    void swap(const Manifest &fresh) const;
    std::string staged() const;

    Request request_;
    std::string inputs_;
    std::string made_;                 ///< the topmost folder that was not there before; empty: all were
    std::shared_ptr<FolderLock> lock_; ///< of the process that began
    std::string owner_;                ///< as the lock says it; empty: nobody began
  };
} // namespace flank
