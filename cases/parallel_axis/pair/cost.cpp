// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/cost.hpp"

#include "cases/parallel_axis/pair/extra.hpp"
#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "cases/work/machine_speed.hpp"
#include "contact/matching/body_size.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/memory.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"
#include "solver/elements/flank_block.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace flank
{
  std::vector<BodyDefinition> planned_requests(const ParallelAxisCase &input, const int processes)
  {
    std::vector<BodyDefinition> requests = input.bodies();
    for (BodyDefinition &request : requests)
      request.model.reduction = reduction_of(request.model, request.resolution, processes);
    return requests;
  }

  bool in_halves(const BodyDefinition &body)
  {
    return body.model.use_mid_plane && body.model.reduction != BodyModel::Reduction::direct &&
           has_mid_plane(body.gear, body.resolution);
  }

  int teeth_of(const BodyDefinition &body)
  {
    return body.model.kind == BodyModel::Kind::ring ? body.gear.teeth : body.model.segment_teeth;
  }

  namespace
  {
    /// Operations of one core's speed that each kind of work comes to, its efficiency included. Fitted to
    /// draft, standard and reference meshes of the spur and helical examples (degree 2); `validation/run
    /// plan` shows what they expect beside what runs take, there and in other cases, and how far each kind of
    /// work is off.
    constexpr double condense_quadratic = 8.5e3, condense_cubic = 3.9, ring_factor = 1.5, block_factor = 0.31,
                     distributed_factor = 8;
    /// Likewise the logarithms that other work comes to: of a near-field table's sources, of a cell, of a
    /// pair of cells, of a pair of them at a free end, and of any where tips are free edges.
    constexpr double table_sources = 2.6e6, cell_linear = 850, cell_quadratic = 1.4, cell_at_end = 1.5,
                     cell_at_tips = 0.9;
    /// A direct reduction takes direct_quadratic operations a tooth times a sector's unknowns squared. Fitted
    /// to a spur ring of 14625 unknowns a sector.
    constexpr double direct_quadratic = 560;
    /// Fields take field_factor operations times a sector's unknowns squared to factor its inside, and
    /// field_cell operations an unknown to solve, sample and write one sector.
    constexpr double field_factor = 3.5, field_cell = 2.0e5;

    /// Contact. A torque band's grid counts with in_contact of its cells in contact; three ready cases at
    /// draft and standard levels end with 0.28 to 0.37, and the factors of wider guesses are paid for too.
    /// Their block is factored factors_at_first times (two to three times: contact/solve/README.md) and in
    /// later mesh cycles, which start warm, factors_again times; all cells are checked by products that take
    /// checks operations a number of the compliance. Fitted with the constants above: validation/run plan.
    constexpr double in_contact = 0.36, factors_at_first = 2.5, factors_again = 2, checks = 6;

    /// Memory of a process that has nothing to compute yet, with Gmsh's and the finite elements' libraries
    /// (200 MB with a body of some dozen elements) and without them (35 MB with its operator and results).
    /// [bytes]
    constexpr double bytes_with_elements = 2.0e8, bytes_without = 0.25e8;

    /// A grid's compliance, the blocks it is put together from and the solver's own, in matrices of all
    /// cells: spur and helical pairs took 1.5 to 2.1 on 2500 to 20000 cells.
    constexpr double matrices_of_grid = 2.3;

    /// What a position keeps of a torque: of each cell of its grid, and of each mesh cycle. Fitted to runs'
    /// memory. [bytes]
    constexpr double kept_of_cell = 20, kept_of_cycle = 3000;

    constexpr double block_width = 2 * block_rings + 1; // about one loaded element [elements]

    /// Free unknowns of a near-field block about one element.
    double block_unknowns(const double degree)
    {
      return 3 * std::pow(block_width * degree - 1, 2) * block_depth * degree;
    }

    /// Layers of elements along a face whose near-field tables differ: three at each end, which a spur gear's
    /// mid-plane makes alike, and one for all between.
    int tabulated_layers(const BodyDefinition &body)
    {
      const int layers = std::min(body.resolution.face_layers, 2 * block_rings + 3);
      return body.gear.base_helix_angle == 0 ? (layers + 1) / 2 : layers;
    }

    double direct_bytes(const BodyDefinition &body)
    {
      return teeth_of(body) * factor_bytes(size_of(body.resolution).unknowns, body.resolution.degree);
    }

    /// Time to reduce one body: MUMPS' condensation and closing the teeth, or all teeth at once; the near
    /// field's tables. [s]
    double reduction_time(const BodyDefinition &body, const int threads, const int processes)
    {
      const SectorResolution &resolution = body.resolution;
      const double parts = in_halves(body) ? 2 : 1, p = resolution.degree;
      const BodySize size = size_of(resolution);
      const double kept = size.kept() / parts, cut = size.cut / 2 / parts, flank = size.flank / parts;
      double condense = condense_quadratic * kept * kept + condense_cubic * kept * kept * kept;
      if (body.model.reduction == BodyModel::Reduction::distributed)
        condense *= distributed_factor / processes;
      const double ring = (body.gear.teeth / 2 + 1) *
                          (cut * cut * cut / 3 + 2 * cut * cut * flank + 4 * cut * flank * flank),
                   segment =
                       (body.model.segment_teeth + 1) * (7.0 / 3 * cut * cut * cut + 4 * cut * cut * flank);
      const double closing = body.model.kind == BodyModel::Kind::ring ? ring_factor * ring : segment;
      const auto seconds = [](const double operations) { return operations / operations_a_second(); };
      const double block = block_unknowns(p);
      const double tables = body.near_field.split == Split::classical
                                ? 0
                                : resolution.flank_rows * tabulated_layers(body) *
                                      (seconds(block_factor * block * block * block) +
                                       table_sources * std::pow((block_width * p + 1) / 11, 2) *
                                           std::pow(body.near_field.points / 5.0, 4) / logarithms_a_second());
      if (body.model.reduction == BodyModel::Reduction::direct)
        return std::max(seconds(direct_quadratic * teeth_of(body) * size.unknowns * size.unknowns),
                        tables / threads);
      // Tables are made beside the condensation, which keeps one thread busy.
      return std::max(seconds(parts * (condense + closing / threads)),
                      (seconds(parts * (condense + closing)) + tables) / threads);
    }

    /// Memory of the process that needs most. [bytes]
    double reduction_bytes(const BodyDefinition &body, const int threads)
    {
      const double blocks = threads * 2.3 * 8 * std::pow(block_unknowns(body.resolution.degree), 2);
      if (body.model.reduction == BodyModel::Reduction::direct)
        return direct_bytes(body) + blocks;
      // Kept unknowns squared: of halves a quarter, and what the first leaves beside the second.
      return 1e9 * size_of(body.resolution).gigabytes() / (in_halves(body) ? 2.8 : 1) + blocks;
    }

    /// Cells of the grids of all torque bands, over phases of a mesh cycle, and how near they come to an end
    /// of the common face width [mm].
    struct CellsOfGrids
    {
      double mean = 0, greatest = 0, to_end = HUGE_VAL;
    };

    CellsOfGrids cells_of(const ParallelAxisCase &input)
    {
      constexpr int phases = 4;
      // A grid that is too small goes on growing until it holds the path of action, of which a fifth is cut
      // off by the flanks' edges.
      const double on_path = 0.8 * input.grid.slices * std::max(1.0, input.pair.total_contact_ratio());
      std::vector<double> greatest; // of each band
      for (const auto &band : torque_bands(input.pair, input.torques))
        greatest.push_back(input.torques[band.front()]);
      CellsOfGrids cells;
      for (int k = 0; k < phases; ++k)
        for (const FirstGrid &grid :
             first_grids(input.pair, input.deviations, input.grid.slices, greatest, 1.0 * k / phases))
          {
            const double of_grid = input.grid.profile_cells * std::max<double>(on_path, grid.slices);
            cells.mean += of_grid / (phases * static_cast<double>(greatest.size()));
            cells.greatest = std::max(cells.greatest, of_grid);
            cells.to_end = std::min({ cells.to_end, grid.to_ends[0], grid.to_ends[1] });
          }
      return cells;
    }

    /// Whether free ends are part of the near field of any cell: a load's block of elements reaches as far.
    bool ends_are_near(const ParallelAxisCase &input, const CellsOfGrids &cells)
    {
      const double layer = std::max(input.pair.pinion.face_width / input.pinion_mesh.face_layers,
                                    input.pair.gear.face_width / input.gear_mesh.face_layers);
      return input.near_field.split == Split::projected && input.near_field.free_ends &&
             cells.to_end < (block_rings + 1) * layer;
    }

    /// Of the grids that are solved on at once, one a thread. [bytes]
    double bytes_of_grids(const CellsOfGrids &cells)
    {
      return available_threads() * matrices_of_grid * 8 * cells.greatest * cells.greatest;
    }

    /// Logarithms that a pair of cells of a grid comes to.
    double of_cell_pair(const ParallelAxisCase &input, const bool near_ends)
    {
      const bool free = input.near_field.split == Split::projected && input.near_field.free_ends,
                 sharp = input.pair.pinion.tip_rounding == 0 || input.pair.gear.tip_rounding == 0;
      const double inside = cell_quadratic + (free && sharp ? cell_at_tips : 0);
      if (!near_ends)
        return inside;
      // Loads on the layers of elements whose block reaches an end, and the cells that lie on this block.
      const double layers = input.pinion_mesh.face_layers,
                   loads = std::min(1.0, 2 * (block_rings + 1) / layers),
                   on_block = std::min(1.0, (1.5 * block_rings + 1) / layers);
      return inside + cell_at_end * loads * on_block;
    }

    /// What all extras cost together; names in `cost` those with seconds.
    ExtraCost cost_of_extras(const ParallelAxisCase &input, const int processes, CostEstimate &cost)
    {
      ExtraCost sum;
      for (const auto &extra : input.extras)
        {
          const ExtraCost own = extra->cost(input, processes);
          sum.grids += own.grids;
          sum.inside_bodies = sum.inside_bodies || own.inside_bodies;
          sum.sector_solutions += own.sector_solutions;
          sum.gigabytes_inside += own.gigabytes_inside;
          sum.seconds += own.seconds;
          sum.gigabytes = std::max(sum.gigabytes, own.gigabytes);
          if (own.inside_bodies)
            cost.with_fields.push_back(extra->name());
          if (own.seconds > 0)
            cost.with_own.push_back(extra->name());
        }
      return sum;
    }

    /// Fields and root stress: each body condensed whole and factored once, then solved for every loaded
    /// tooth. Adds the time; returns the memory.
    double add_inside_of_bodies(const std::vector<BodyDefinition> &requests, const ExtraCost &extras,
                                const int threads, const int processes, CostEstimate &cost)
    {
      double peak = 0;
      for (const BodyDefinition &body : requests)
        {
          const double unknowns = size_of(body.resolution).unknowns;
          BodyDefinition whole = body;
          whole.model.use_mid_plane = false;
          whole.model.reduction = BodyModel::Reduction::condensed;
          whole.near_field.split = Split::classical; // no tables
          const double sides = requests.size() == 1 ? 2 : 1;
          cost.field_seconds += reduction_time(whole, threads, 1) +
                                (field_factor * unknowns * unknowns +
                                 sides * extras.sector_solutions / processes * field_cell * unknowns) /
                                    operations_a_second();
          peak = std::max(peak, reduction_bytes(whole, threads));
        }
      return peak + 1e9 * extras.gigabytes_inside;
    }
  } // namespace

  double contact_bytes(const ParallelAxisCase &input)
  {
    return bytes_of_grids(cells_of(input));
  }

  double bytes_to_reduce(BodyDefinition body, const int processes)
  {
    body.model.reduction = reduction_of(body.model, body.resolution, processes);
    return reduction_bytes(body, available_threads());
  }

  CostEstimate estimate_cost(const ParallelAxisCase &input, const int processes)
  {
    const int threads = available_threads(),
              workers = std::max(1, std::min(processes * threads, machine_cores()));
    CostEstimate cost;
    const ExtraCost extras = cost_of_extras(input, processes, cost);
    cost.start_seconds = processes == 1 ? start_seconds::one_process : start_seconds::ranks;
    double operators = 0, peak = 0;
    // As `reduced_bodies`: the ranks take the bodies in turn, all together one that is distributed.
    std::vector<double> seconds(processes, 0.0);
    int next = 0;
    const auto requests = planned_requests(input, processes);
    for (const BodyDefinition &body : requests)
      {
        const int owner = next++ % processes;
        operators += 1e9 * operator_gigabytes(body);
        if (OperatorCache::of_user().holds(operator_key(body)))
          continue;
        const double own = reduction_time(body, threads, processes);
        if (body.model.reduction == BodyModel::Reduction::distributed)
          for (double &all : seconds)
            all = *std::max_element(seconds.begin(), seconds.end()) + own;
        else
          seconds[owner] += own;
        peak = std::max(peak, reduction_bytes(body, threads) + operators);
      }
    if (peak > 0 || extras.inside_bodies)
      cost.start_seconds += start_seconds::elements;
    cost.reduction_seconds = *std::max_element(seconds.begin(), seconds.end());
    for (const auto &band : torque_bands(input.pair, input.torques))
      {
        ++cost.bands;
        cost.torques += static_cast<int>(band.size());
      }
    const CellsOfGrids of_grids = cells_of(input);
    const double cells = of_grids.mean, n_grids = 1.0 * input.positions * (cost.bands + extras.grids),
                 active = in_contact * cells;
    const double first = n_grids, again = 1.0 * input.positions * (input.cycles - 1) *
                                          cost.bands; // solutions: later cycles start warm
    cost.near_ends = ends_are_near(input, of_grids);
    const double assembling = n_grids * (cell_linear + of_cell_pair(input, cost.near_ends) * cells) * cells,
                 solving = (factors_at_first * first + factors_again * again) * active * active * active / 3 +
                           checks * (first + again) * cells * cells;
    cost.cells = cells;
    cost.contact_seconds = (assembling / logarithms_a_second() + solving / operations_a_second()) / workers;
    if (extras.inside_bodies)
      peak = std::max(peak, operators + add_inside_of_bodies(requests, extras, threads, processes, cost));
    cost.gigabytes = 1e-9 * ((peak > 0 ? bytes_with_elements : bytes_without) +
                             std::max(peak, operators + bytes_of_grids(of_grids) +
                                                1.0 * input.positions * cost.torques *
                                                    (cells * kept_of_cell + input.cycles * kept_of_cycle)));
    cost.extra_seconds = extras.seconds;
    if (extras.gigabytes > 0)
      cost.gigabytes = std::max(cost.gigabytes, extras.gigabytes + 1e-9 * operators);
    return cost;
  }

  void require_memory_of(const CostEstimate &cost, const int processes_on_node)
  {
    require_memory(1e9 * cost.gigabytes, processes_on_node, "this run",
                   "lower accuracy, mesh or contact_grid keys, positions or torques; or use fewer threads "
                   "(FLANK_THREADS) or processes");
  }
} // namespace flank
