// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/study.hpp"

#include "cases/parallel_axis/accuracy_target.hpp"
#include "cases/parallel_axis/extras/extras.hpp"
#include "cases/parallel_axis/pair/cost.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "cases/parallel_axis/study_estimates.hpp"
#include "cases/parallel_axis/study_groups.hpp"
#include "cases/parallel_axis/study_plan.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/parallel_axis/whole_run.hpp"
#include "cases/study/study_axes.hpp"
#include "cases/work/body_store.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

namespace flank
{
  namespace
  {
    class ParallelAxisStudy : public StudyWork
    {
    public:
      explicit ParallelAxisStudy(const StudyAxes &axes);

      StudyColumns columns() const override
      {
        return { .abscissa = "phase", .abscissa_unit = "mesh cycle", .has_bounds = true };
      }
      void enumerate() override;
      double bytes() const override;
      double bytes_of_process(int processes) const override;

      std::shared_ptr<const VariantFrame> frame(const long variant) const override
      {
        return all_.frames[variant];
      }
      std::string refusal(long variant) const override;

      std::vector<std::string> files() const override { return { all_.files.begin(), all_.files.end() }; }

      int n_stages() const override { return static_cast<int>(all_.stages.size()); }
      const std::vector<StudyPiece> &pieces(const int stage) const override
      {
        return all_.stages[stage].pieces;
      }
      void prepare(int stage, const ParallelSession &session) override;
      std::vector<StudyOutcome> solve(const StudyPiece &piece) const override;
      BeyondTables beyond_tables(Journal &journal, const ResultFolder &folder,
                                 const std::function<bool(long)> &has_failed) override;
      std::string plan(int processes) override;

    private:
      using Shared = std::map<std::string,
                              std::unique_ptr<PositionCompliance>>; ///< of one position, by identity_of_cells
      /// What the plan of a study adds up.
      struct Needs
      {
        std::size_t bodies = 0; ///< distinct ones
        int cached = 0;         ///< of them
        double reduction_seconds = 0, contact_seconds = 0;
        double solutions = 0; ///< of contacts
      };

      /// A variant on its bodies: the pair refers to the case beside it.
      struct Evaluator
      {
        long variant;
        ParallelAxisCase input;
        std::optional<LoadedPair> mesh;
      };
      std::unique_ptr<const Evaluator> evaluator(long variant) const;
      LoadedPair pair_of(long variant, std::unique_ptr<const Evaluator> &last) const;

      /// `input`: of `mesh` but for its deviations. `kept`: what extras need, which then stands in the
      /// records of the outcome; null: there are none.
      StudyOutcome solve(const ParallelAxisCase &input, LoadedPair mesh, const std::vector<int> &positions,
                         const Kept *kept, Shared &shared) const;
      void add_first(Journal &journal, const ResultFolder &folder, BeyondTables &result);
      std::vector<std::vector<long>> variants_of_groups() const;
      Needs needs(int processes) const;

      const StudyAxes &axes_;
      StudyGroups all_;
      std::map<std::string, std::shared_ptr<const BodyCompliance>> bodies_; ///< of the stage, by operator key
      std::optional<ParallelAxisCase> first_; ///< the first variant with its extras, where it has any
      bool every_variant_ = false;            ///< has an error estimate
    };

    ParallelAxisStudy::ParallelAxisStudy(const StudyAxes &axes)
        : axes_(axes)
    {
    }

    double ParallelAxisStudy::bytes() const
    {
      const auto of_variant = axes_.of_first_taken([](const CaseFile &file) {
        const ParallelAxisCase input = read_parallel_axis(file);
        const double points =
            1.0 * input.positions * input.cycles * static_cast<double>(input.torques.size());
        return 200 + points * (sizeof(StudyPoint) + 8.0 * static_cast<double>(parameters_of(input).size()));
      });
      return static_cast<double>(axes_.n_variants()) * of_variant.value_or(200);
    }

    double ParallelAxisStudy::bytes_of_process(const int processes) const
    {
      double most = 0; // bodies of a stage, and what reducing one of them takes
      for (const StudyGroups::Stage &stage : all_.stages)
        {
          double operators = 0, reduction = 0;
          for (std::size_t k = 0; k < stage.requests.size(); ++k)
            {
              operators += 1e9 * operator_gigabytes(stage.requests[k]);
              if (!OperatorCache::of_user().holds(stage.keys[k]))
                reduction = std::max(reduction, bytes_to_reduce(stage.requests[k], processes));
            }
          most = std::max(most, operators + std::max(reduction, all_.contact_bytes));
        }
      return most;
    }

    ParallelAxisCase with_extras_of_studies(ParallelAxisCase input)
    {
      for (const ExtraKind &kind : pair_extras())
        std::erase_if(input.extras,
                      [&](const auto &extra) { return extra->name() == kind.name && !kind.in_studies; });
      return input;
    }

    /// The first variant as a run has it, with the extras that studies have; nothing if its input is refused.
    std::optional<ParallelAxisCase> first_with_extras(const StudyAxes &axes)
    try
      {
        ParallelAxisCase input = with_extras_of_studies(read_parallel_axis(axes.variant(0)));
        return input.extras.empty() ? std::nullopt : std::optional(std::move(input));
      }
    catch (const InputError &)
      {
        return std::nullopt;
      }

    /// Those that studies have of their first variant, or those that they do not have, but for one.
    std::vector<std::string> names_of_extras(const bool in_studies, const std::string &but = {})
    {
      std::vector<std::string> names;
      for (const ExtraKind &kind : pair_extras())
        if (kind.in_studies == in_studies && kind.name != but)
          names.push_back(kind.name);
      return names;
    }

    void ParallelAxisStudy::enumerate()
    {
      first_ = first_with_extras(axes_);
      every_variant_ = asks_for_every_estimate(axes_);
      all_ = StudyGroups(axes_);
    }

    std::string ParallelAxisStudy::refusal(const long variant) const
    {
      try
        {
          read_parallel_axis(axes_.variant(variant));
        }
      catch (const InputError &error)
        {
          return error.what();
        }
      return {};
    }

    void ParallelAxisStudy::prepare(const int stage, const ParallelSession &session)
    {
      bodies_.clear();
      StageClock clock;
      const auto &keys = all_.stages[stage].keys;
      const auto bodies =
          reduced_bodies(all_.stages[stage].requests, OperatorCache::of_user(), &session, clock);
      for (std::size_t k = 0; k < keys.size(); ++k)
        bodies_[keys[k]] = bodies[k];
    }

    std::unique_ptr<const ParallelAxisStudy::Evaluator> ParallelAxisStudy::evaluator(const long variant) const
    {
      std::unique_ptr<Evaluator> result(
          new Evaluator{ variant, read_parallel_axis(axes_.variant(variant)), std::nullopt });
      const auto requests = result->input.bodies();
      result->mesh.emplace(loaded_pair(result->input, { bodies_.at(operator_key(requests.front())),
                                                        bodies_.at(operator_key(requests.back())) }));
      result->mesh->derivatives = result->input.derivatives;
      return result;
    }

    /// The values of all parameters in a variant that changes nothing else; nothing for others. (Nothing
    /// removed is no modification, and what was one has its parameters no longer.)
    std::optional<std::vector<double>> parameter_values(
        const ParallelAxisCase &input, const std::vector<std::pair<std::string, double>> &changes)
    {
      std::vector<double> values = input.deviations.values();
      for (const auto &[key, value] : changes)
        {
          const auto place = std::find(input.parameters.begin(), input.parameters.end(), key);
          if (place == input.parameters.end() || value == 0)
            return std::nullopt;
          values[place - input.parameters.begin()] = value;
        }
      return values;
    }

    /// The pair of a variant with its deviations, made from the last variant that was read where
    /// modifications' numbers are all that changes; else the variant is read, and becomes the last one.
    /// (Coast flanks that count are read: they have the modifications too.)
    LoadedPair ParallelAxisStudy::pair_of(const long variant, std::unique_ptr<const Evaluator> &last) const
    {
      if (last && !last->mesh->coast)
        if (const auto changes = axes_.changes(variant, last->variant))
          if (const auto values = parameter_values(last->input, *changes))
            return last->mesh->with(*values);
      last = evaluator(variant);
      return *last->mesh;
    }

    /// `load`: its number. One without a solution fails, alone.
    void add_result(const ParallelAxisCase &input, const PositionResult &result, const std::size_t load,
                    StudyOutcome &outcome)
    {
      std::vector<double> by_parameter(parameters_of(input).size());
      if (result.failure.empty())
        {
          outcome.points.push_back(study_point(input.pair, result));
          by_parameter = transmission_error_um_by_parameter(input.pair, result);
        }
      else
        {
          outcome.points.emplace_back();
          outcome.failures.resize(input.torques.size());
          if (outcome.failures[load].empty())
            outcome.failures[load] = result.failure;
        }
      outcome.derivatives.insert(outcome.derivatives.end(), by_parameter.begin(), by_parameter.end());
    }

    StudyOutcome ParallelAxisStudy::solve(const ParallelAxisCase &input, LoadedPair mesh,
                                          const std::vector<int> &positions, const Kept *kept,
                                          Shared &shared) const
    {
      if (kept)
        mesh.measures = kept->measures;
      mesh.keep_cells = kept && kept->keep_cells(positions.front());
      auto &compliance = shared[identity_of_cells(input.pair, input.grid)];
      if (!compliance)
        compliance = std::make_unique<PositionCompliance>(mesh.compliance());
      const double phase = static_cast<double>(positions.front()) / input.positions;
      std::vector<int> cycles(positions.size());
      std::iota(cycles.begin(), cycles.end(), 0);
      StudyOutcome outcome;
      const auto at = mesh.solve_all(mesh.at(phase), input.torques, cycles, *compliance);
      if (kept)
        outcome.records = records_of_position(input, mesh.bodies, positions.front(), at);
      for (const auto &of_cycle : at)
        for (std::size_t t = 0; t < of_cycle.size(); ++t)
          add_result(input, of_cycle[t], t, outcome);
      return outcome;
    }

    std::vector<StudyOutcome> ParallelAxisStudy::solve(const StudyPiece &piece) const
    {
      std::vector<StudyOutcome> outcomes;
      Shared shared;
      const Kept kept_of_first = first_ ? kept_for_extras(*first_) : Kept{}, nothing;
      std::unique_ptr<const Evaluator> last;
      for (const long variant : piece.variants)
        try
          {
            LoadedPair mesh = pair_of(variant, last);
            const Kept *kept = first_ && variant == 0 ? &kept_of_first : every_variant_ ? &nothing : nullptr;
            outcomes.push_back(solve(last->input, std::move(mesh), piece.positions, kept, shared));
            for (Journal::Record &record : outcomes.back().records)
              record.name = before_names_of(variant) + record.name;
          }
        catch (const ComputationError &error)
          {
            outcomes.push_back({ .failure = error.what() });
          }
      return outcomes;
    }

    /// The first variant's positions are in the journal, as a run keeps them: only what is missing or damaged
    /// there is solved.
    void ParallelAxisStudy::add_first(Journal &journal, const ResultFolder &folder, BeyondTables &result)
    {
      require_memory_of(estimate_cost(*first_, 1), 1);
      for (ExtraOutput &extra :
           run_with_extras(*first_, SharedWork(nullptr, &journal), folder, [&](const TorquesFailed &failed) {
             return with_extras_of_studies(without(failed, axes_.variant(0), *first_));
           }).extras)
        {
          result.summary += extra.summary;
          if (!extra.bounds.empty())
            result.bounds[0] = design_bounds(extra.bounds);
          if (extra.table)
            result.tables.push_back(std::move(*extra.table));
        }
    }

    BeyondTables ParallelAxisStudy::beyond_tables(Journal &journal, const ResultFolder &folder,
                                                  const std::function<bool(long)> &has_failed)
    {
      BeyondTables result;
      bodies_.clear(); // of the last stage
      try
        {
          if (first_ && !has_failed(0))
            add_first(journal, folder, result);
          if (every_variant_)
            add_estimates_of_variants(axes_, variants_of_groups(), has_failed, journal, folder, result);
        }
      catch (const LibraryError &)
        {
          throw;
        }
      catch (const std::exception &error) // a computation, too little memory
        {
          result.failure = error.what();
        }
      return result;
    }

    std::vector<std::vector<long>> ParallelAxisStudy::variants_of_groups() const
    {
      std::vector<std::vector<long>> result;
      for (const StudyGroups::Group &group : all_.groups)
        result.push_back(group.variants);
      return result;
    }

    /// What all variants take together; what is asked of the first one is apart.
    ParallelAxisStudy::Needs ParallelAxisStudy::needs(const int processes) const
    {
      Needs sum;
      std::set<std::string> bodies;
      for (const StudyGroups::Group &group : all_.groups)
        {
          ParallelAxisCase input = read_parallel_axis(axes_.variant(group.variants.front()));
          input.extras.clear();
          const CostEstimate cost = estimate_cost(input, processes);
          bool fresh = false;
          for (const std::string &key : group.keys)
            if (bodies.insert(key).second)
              {
                fresh = true;
                sum.cached += OperatorCache::of_user().holds(key);
              }
          sum.reduction_seconds += fresh ? cost.reduction_seconds : 0;
          const auto n = static_cast<double>(group.variants.size()),
                     pieces = std::ceil(n / static_cast<double>(variants_a_piece));
          sum.contact_seconds += cost.contact_seconds * (pieces + another_variant * (n - pieces));
          sum.solutions += n * static_cast<double>(all_.frames[group.variants.front()]->abscissa.size() *
                                                   input.torques.size());
        }
      sum.bodies = bodies.size();
      return sum;
    }

    std::string ParallelAxisStudy::plan(const int processes)
    {
      constexpr long most_looked_at = 10'000;
      constexpr double most_letters = 1e6; // about a second, as those many variants
      if (axes_.n_variants() > most_looked_at || axes_.letters() > most_letters)
        return plan_by_axes(axes_, processes, bytes());
      enumerate();
      const Needs all = needs(processes);
      double of_first_seconds = 0, gigabytes = 0.1 + 1e-9 * (bytes() + bytes_of_process(processes));
      std::string of_first;
      if (first_)
        {
          of_first = "  of the first variant, from its positions, which are solved once:\n";
          for (const auto &asked : first_->extras)
            for (const std::string &line : asked->plan(*first_).computed)
              of_first += "    " + line + "\n";
          if (every_variant_)
            of_first += "  the error estimates of all other variants likewise, one after the other\n";
          const CostEstimate cost = estimate_cost(*first_, 1); // on rank 0
          of_first_seconds = cost.field_seconds + cost.extra_seconds;
          if (every_variant_) // reduced once
            of_first_seconds += static_cast<double>(axes_.n_variants() - 1) * seconds_of_estimate(*first_);
          gigabytes = std::max(gigabytes, cost.gigabytes);
        }
      const auto refused = std::count(all_.frames.begin(), all_.frames.end(), nullptr);
      return fmt::format(
          "Will be computed\n  {} distinct {}{}\n  {:.0f} contact {} in {} "
          "of equal bodies\n{}"
          "Left out\n  reductions for what changes gaps alone: torques, modifications, "
          "misalignment, single teeth\n"
          "  load lines, patterns, pair loads, {}; {} of other variants than the first: flank run of one "
          "variant has them\n"
          "{}Expected on this machine, {} of {}\n  reduction {} s, contact {} "
          "s{}, all {} s; {} GB a process\n",
          all.bodies, noun_for(static_cast<double>(all.bodies), "body", "bodies"),
          all.cached == 0   ? ""
          : all.bodies == 1 ? ", cached"
                            : fmt::format(", {} of them cached", all.cached),
          all.solutions, noun_for(all.solutions, "solution"), counted(all_.groups.size(), "group"), of_first,
          fmt::join(names_of_extras(false), ", "),
          fmt::join(names_of_extras(true, every_variant_ ? error_estimate_name : ""), ", "),
          refused > 0 ? "Refused as input: " + counted(refused, "variant") + "\n" : "",
          counted(processes, "process", "processes"), counted(available_threads(), "thread"),
          two_digits(all.reduction_seconds), two_digits(all.contact_seconds),
          first_ ? fmt::format(", the first variant's own {} s", two_digits(of_first_seconds)) : "",
          two_digits(start_seconds::drive_or_study + all.reduction_seconds + all.contact_seconds +
                     of_first_seconds),
          two_digits(gigabytes));
    }
  } // namespace

  std::unique_ptr<StudyWork> parallel_axis_study(const StudyAxes &axes)
  {
    refuse_accuracy_target(axes.variant(0));
    return std::make_unique<ParallelAxisStudy>(axes);
  }
} // namespace flank
