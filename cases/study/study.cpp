// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/study.hpp"

#include "cases/study/study_axes.hpp"
#include "cases/study/study_results.hpp"
#include "cases/study/study_work.hpp"
#include "cases/work/packing.hpp"
#include "cases/work/stop_on_signal.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/memory.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>

namespace flank
{
  namespace
  {
    /// What the journal knows a piece by.
    std::string name_of(const int stage, const StudyPiece &piece)
    {
      return fmt::format("stage {}, variants {}, positions {}", stage, fmt::join(piece.variants, " "),
                         fmt::join(piece.positions, " "));
    }

    /// The one list of what a record holds of a variant.
    template <class Archive, class Outcome>
    void fields_of_outcome(Archive &archive, Outcome &outcome)
    {
      archive.fields(outcome.failure, outcome.points, outcome.derivatives);
      archive.list(outcome.failures, [](auto &of, auto &failure) { of.fields(failure); });
    }

    std::vector<char> pack(const StudyPiece &piece, const std::vector<StudyOutcome> &outcomes)
    {
      Packer out;
      out.fields(piece.variants, piece.positions);
      for (const StudyOutcome &outcome : outcomes)
        fields_of_outcome(out, outcome);
      return std::move(out.result);
    }

    /// Whether it can be what a variant has at so many points.
    bool is_sound(const StudyOutcome &outcome, const std::size_t points, const std::size_t loads,
                  const std::size_t parameters)
    {
      if (!outcome.failure.empty())
        return true;
      if (!outcome.failures.empty() && outcome.failures.size() != loads)
        return false;
      constexpr double most = 1e15; // what no result comes near to
      const auto is_number = [](const double value) { return std::abs(value) < most; };
      return outcome.points.size() == points && outcome.derivatives.size() == points * parameters &&
             std::ranges::all_of(outcome.derivatives, is_number) &&
             std::ranges::all_of(outcome.points, [&](const StudyPoint &p) {
               return is_number(p.response) && is_number(p.response_slope) && is_number(p.max_pressure) &&
                      p.max_pressure >= 0 && is_number(p.edge_pressure) && p.edge_pressure >= 0 &&
                      is_number(p.stiffness) && p.contacts >= 0 && is_number(p.certificate) &&
                      p.certificate >= 0;
             });
    }

    /// What pack() made of a piece; nothing if these bytes are no such thing.
    std::optional<std::vector<StudyOutcome>> unpack(const std::vector<char> &bytes, const StudyPiece &piece,
                                                    const StudyWork &work)
    try
      {
        std::vector<StudyOutcome> outcomes;
        Unpacker in(bytes);
        StudyPiece of;
        in.fields(of.variants, of.positions);
        if (of.variants != piece.variants || of.positions != piece.positions)
          return std::nullopt;
        for (const long variant : piece.variants)
          {
            StudyOutcome outcome;
            fields_of_outcome(in, outcome);
            const auto frame = work.frame(variant);
            const std::size_t loads = frame ? frame->loads.size() : 0;
            if (!is_sound(outcome, piece.positions.size() * loads, loads,
                          frame ? frame->parameters.size() : 0))
              return std::nullopt;
            outcomes.push_back(std::move(outcome));
          }
        return in.at_end() ? std::optional(std::move(outcomes)) : std::nullopt;
      }
    catch (const UnusableRecord &)
      {
        return std::nullopt;
      }

    /// Which pieces of a stage the journal does not hold, of those that are this call's. Decided by rank 0,
    /// which alone reads journals.
    std::vector<std::size_t> pieces_left(const int stage, const StudyWork &work, Journal &journal,
                                         const StudyPart &part, const ParallelSession &session, long &done)
    {
      const auto &pieces = work.pieces(stage);
      std::vector<char> held(pieces.size(), 0);
      if (session.rank() == 0)
        for (std::size_t k = 0; k < pieces.size(); ++k)
          while (const auto found = journal.find(name_of(stage, pieces[k])))
            {
              held[k] = unpack(*found, pieces[k], work).has_value();
              if (held[k])
                break;
              journal.reject(name_of(stage, pieces[k]));
            }
      session.broadcast(held);
      std::vector<std::size_t> left;
      for (std::size_t k = 0; k < pieces.size(); ++k)
        if (held[k])
          ++done;
        else if (static_cast<int>(k % part.count) == part.number)
          left.push_back(k);
      return left;
    }

    /// The piece is the last: where it is held, what goes with it is.
    void keep(const int stage, const StudyPiece &piece, const std::vector<StudyOutcome> &outcomes,
              Journal &journal)
    {
      for (const StudyOutcome &outcome : outcomes)
        for (const Journal::Record &record : outcome.records)
          journal.append(record.name, record.content);
      journal.append(name_of(stage, piece), pack(piece, outcomes));
    }

    /// How many pieces the journals hold, and how many there are.
    std::string pieces_done(const StudyWork &work, const Journal &journal)
    {
      long held = 0, all = 0;
      for (int stage = 0; stage < work.n_stages(); ++stage)
        for (const StudyPiece &piece : work.pieces(stage))
          {
            held += journal.holds(name_of(stage, piece));
            ++all;
          }
      return fmt::format("{} of {}", held, counted(all, "piece"));
    }

    std::string in_words(const double seconds)
    {
      return seconds < 120    ? fmt::format("{:.0f} s", seconds)
             : seconds < 7200 ? fmt::format("{:.0f} min", seconds / 60)
                              : fmt::format("{:.1f} h", seconds / 3600);
    }
  } // namespace

  namespace
  {
    /// All pieces that are left, stage by stage; true if a signal stopped it.
    bool compute_pieces(StudyWork &work, Journal &journal, const StudyPart &part,
                        const ParallelSession &session, const long all)
    {
      const StopOnSignal stop; // after the pieces in work
      const int rank = session.rank();
      const auto start = std::chrono::steady_clock::now();
      long done = 0, begun = 0; // pieces; of this call, in earlier stages
      bool stopped = false;
      for (int stage = 0; stage < work.n_stages() && !stopped; ++stage)
        {
          const std::vector<std::size_t> left = pieces_left(stage, work, journal, part, session, done);
          const auto &pieces = work.pieces(stage);
          if (left.empty())
            continue;
          work.prepare(stage, session);
          SharedCounter counter(session);
          std::atomic<long> shown{ 0 };
          const auto n = static_cast<long>(left.size());
          parallel_for(available_threads(), [&](int) {
            while (!stop.is_asked())
              {
                const long k = counter.next();
                if (k >= n)
                  return;
                const StudyPiece &piece = pieces[left[k]];
                keep(stage, piece, work.solve(piece), journal);
                // The counter tells how far all ranks are.
                if (const long tenth = 50 * k / n; rank == 0 && shown.exchange(tenth) != tenth)
                  {
                    const double seconds =
                        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
                    spdlog::info("study: {} of {}, about {} left", done + k, counted(all, "piece"),
                                 in_words(seconds / static_cast<double>(begun + k + 1) *
                                          static_cast<double>(all - done - k)));
                  }
              }
          });
          stopped = session.any(stop.is_asked()); // every rank is here: all pieces are in the journals
          done += n;
          begun += n;
        }
      session.wait();
      return stopped;
    }

    /// The tables of all variants, from the journals. Throws OutputError where a piece cannot be read back.
    void fill(StudyTable &table, const StudyWork &work, const Journal &journal)
    {
      long missing = 0;
      for (int stage = 0; stage < work.n_stages(); ++stage)
        for (const StudyPiece &piece : work.pieces(stage))
          {
            const auto bytes = journal.find(name_of(stage, piece));
            auto outcomes = bytes ? unpack(*bytes, piece, work) : std::nullopt;
            missing += !outcomes;
            for (std::size_t k = 0; outcomes && k < piece.variants.size(); ++k)
              table.add(piece.variants[k], piece.positions, std::move((*outcomes)[k]));
          }
      if (missing > 0)
        throw OutputError(counted(missing, "piece") + " cannot be read back from the journals");
      table.leave_out_failed_loads();
    }
  } // namespace

  StudyReport run_study(const CaseFile &file, const Scene &scene, RunContext &context, const StudyPart &part)
  {
    const ParallelSession &session = context.session;
    const StudyAxes axes(file);
    axes.require_no_settings();
    const auto work = scene.study(axes);
    require_memory(work->bytes(), 1, "the tables of this study", "make the axes shorter, or split the study");
    work->enumerate();
    require_memory(work->bytes() + work->bytes_of_process(session.ranks()), session.ranks_on_node(),
                   "the variant of this study that needs most",
                   "lower its accuracy, mesh or contact_grid keys; or use fewer threads (FLANK_THREADS) or "
                   "processes");
    std::vector<std::string> files = file.files();
    for (const auto &others : { axes.files(), work->files() })
      files.insert(files.end(), others.begin(), others.end());

    StudyReport result;
    result.variants = axes.n_variants();
    const std::string of_case = file.inputs(); // which reads the case's own files before they are listed
    result.summary = context.with_folder(
        of_case + axes.text() + file.files_read(), files, [&](Journal &journal) -> std::string {
          long all = 0;
          for (int stage = 0; stage < work->n_stages(); ++stage)
            all += static_cast<long>(work->pieces(stage).size());
          result.stopped = compute_pieces(*work, journal, part, session, all);
          if (session.rank() != 0)
            return {};
          context.folder.require_not_lost(); // else the journals there are somebody else's
          journal.reread();
          if (result.stopped)
            return fmt::format("stopped: {} are done; go on with --resume\n", pieces_done(*work, journal));
          if (part.count > 1)
            return fmt::format("part {} of {} is done, {} of all parts; "
                               "when all are, flank study --resume makes the tables\n",
                               part.number + 1, part.count, pieces_done(*work, journal));
          StudyTable table(axes, *work);
          fill(table, *work, journal);
          const BeyondTables beyond = work->beyond_tables(
              journal, context.folder, [&](const long variant) { return table.has_failed(variant); });
          context.failures = table.failures(beyond);
          const std::string summary = table.write(context.folder, file, beyond, context.versions);
          context.folder.finish(context.failures);
          return summary;
        });
    return result;
  }

  std::string plan_study(const CaseFile &file, const Scene &scene, const int processes)
  {
    const StudyAxes axes(file);
    try
      {
        return counted(axes.n_variants(), "variant") + " of " + counted(axes.keys().size(), "key") + "\n" +
               scene.study(axes)->plan(processes);
      }
    catch (const StudyRefused &refused) // a run of this case is computed all the same
      {
        return std::string("refused: ") + refused.what() + "\n";
      }
  }
} // namespace flank
