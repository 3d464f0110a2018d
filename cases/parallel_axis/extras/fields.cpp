// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/extras/free_edges.hpp"
#include "cases/results/field_view.hpp"
#include "contact/stress/body_field.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"
#include "solver/libraries/vtu_file.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>

namespace flank
{
  namespace
  {
    /// What is written for ParaView.
    struct FieldRequest
    {
      bool displacement = false, stress = false, contact = false;
      std::vector<int> positions, torques; ///< of the case's, by number
      int teeth = 5;                       ///< of each body, odd

      bool any() const { return in_bodies() || contact; }
      bool in_bodies() const { return displacement || stress; }
    };

    template <class Value>
    void refuse_repeats(const CaseFile &file, const std::string &key, std::vector<Value> values)
    {
      std::sort(values.begin(), values.end());
      if (std::adjacent_find(values.begin(), values.end()) != values.end())
        throw InputError(file.place(key) + "says the same twice; give it once");
    }

    FieldRequest field_request(const CaseFile &file, const ParallelAxisCase &input)
    {
      FieldRequest request;
      for (const std::string &what : file.texts("output.fields"))
        (what == "displacement" ? request.displacement
         : what == "stress"     ? request.stress
                                : request.contact) = true;
      request.teeth = file.integer("output.field_teeth");
      const int fewest = std::min(input.pair.pinion.teeth, input.pair.gear.teeth);
      if (request.teeth % 2 == 0 || request.teeth > fewest)
        throw InputError(file.place("output.field_teeth") +
                         fmt::format("must be odd and at most {}", fewest));
      request.positions = { 0 };
      if (file.has("output.field_positions"))
        {
          request.positions.clear();
          for (const double position : file.numbers("output.field_positions"))
            {
              if (position != std::floor(position) || position >= input.positions)
                throw InputError(file.place("output.field_positions") +
                                 fmt::format("{:g} is not a position, allowed are whole numbers from 0 to {}",
                                             position, input.positions - 1));
              request.positions.push_back(static_cast<int>(position));
            }
        }
      const auto &torques = input.torques;
      request.torques = { static_cast<int>(std::max_element(torques.begin(), torques.end()) -
                                           torques.begin()) };
      if (file.has("output.field_torques_Nm"))
        {
          request.torques.clear();
          for (const double torque : file.numbers("output.field_torques_Nm"))
            {
              const auto at = std::find(torques.begin(), torques.end(), torque * units::newton_metre);
              if (at == torques.end() || torque == 0)
                throw InputError(
                    file.place("output.field_torques_Nm") +
                    fmt::format(
                        "{:g} N m is not computed; allowed are those of load.pinion_torque_Nm above 0",
                        torque));
              request.torques.push_back(static_cast<int>(at - torques.begin()));
            }
        }
      std::sort(request.positions.begin(), request.positions.end());
      std::sort(request.torques.begin(), request.torques.end());
      refuse_repeats(file, "output.fields", file.texts("output.fields"));
      refuse_repeats(file, "output.field_positions", request.positions);
      refuse_repeats(file, "output.field_torques_Nm", request.torques);
      if (!request.any())
        for (const char *key : { "output.field_positions", "output.field_torques_Nm", "output.field_teeth" })
          if (file.has(key))
            throw InputError(file.place(key) + "has no effect without output.fields");
      if (!request.in_bodies() && file.has("output.field_teeth"))
        throw InputError(file.place("output.field_teeth") +
                         "has no effect on contact fields; it is of displacement and stress");
      if (request.any() && torques[request.torques.back()] == 0)
        throw InputError(file.place("output.fields") +
                         "no torque above 0 is computed: there is nothing to show");
      return request;
    }

    /// One position at one torque, by their numbers in the case.
    struct Place
    {
      int position, torque;
    };

    std::vector<Place> places_of(const FieldRequest &request)
    {
      std::vector<Place> places;
      for (const int position : request.positions)
        for (const int torque : request.torques)
          places.push_back({ position, torque });
      return places;
    }

    std::vector<int> teeth_around(const int count)
    {
      std::vector<int> teeth;
      for (int tooth = -(count / 2); tooth <= count / 2; ++tooth)
        teeth.push_back(tooth);
      return teeth;
    }

    std::string torque_name(const ParallelAxisCase &input, const int torque)
    {
      return fmt::format("{:.9g}Nm", input.torques[torque] / units::newton_metre);
    }

    std::string name_of(const ParallelAxisCase &input, const Place &place, const char *what)
    {
      return fmt::format("{}_{}_position_{:04d}", what, torque_name(input, place.torque), place.position);
    }

    void write(const ResultFolder &folder, const std::string &name, const FieldPiece &piece)
    {
      folder.write("fields/" + name, [&](const std::string &path) { write_vtu(path, piece); });
    }

    /// What opens the files of all positions together, a series a torque; its time is the phase of the mesh
    /// cycle.
    void write_series(const FieldRequest &request, const ParallelAxisCase &input, const ResultFolder &folder)
    {
      const auto series = [&](const char *what, const int torque, const std::string &ending) {
        std::vector<std::pair<double, std::string>> files;
        for (const int position : request.positions)
          files.emplace_back(1.0 * position / input.positions,
                             name_of(input, { position, torque }, what) + ending);
        folder.write(fmt::format("fields/{}_{}.pvd", what, torque_name(input, torque)),
                     [&](const std::string &path) { write_pvd(path, files); });
      };
      for (const int torque : request.torques)
        {
          if (request.in_bodies())
            {
              for (const int position : request.positions)
                {
                  const Place place{ position, torque };
                  folder.write("fields/" + name_of(input, place, "bodies") + ".pvtu",
                               [&](const std::string &path) {
                                 write_pvtu(path, body_arrays(request.displacement, request.stress),
                                            { name_of(input, place, "pinion") + ".vtu",
                                              name_of(input, place, "gear") + ".vtu" });
                               });
                }
              series("bodies", torque, ".pvtu");
            }
          if (request.contact)
            series("contact", torque, ".vtu");
        }
    }

    /// The teeth of one body at one place, with the near loads that some of them point to.
    struct LoadedField
    {
      std::unique_ptr<const std::map<int, NearLoads>> near;
      std::vector<ToothField> teeth;
    };

    LoadedField loaded_field(const LoadedTeeth &inside, const ContactRegion &region,
                             const BodyElements &elements, const FlankEdges *edges,
                             const PositionResult &contact, const Side side, const TeethLoads &loads,
                             const std::map<int, CutDisplacement> &cuts, const std::vector<int> &teeth)
    {
      LoadedField field;
      field.near = std::make_unique<const std::map<int, NearLoads>>(
          near_loads(elements.sector().gear, flank_surface(elements.sector()), edges, contact, side));
      for (const int tooth : teeth)
        {
          ToothField &added = field.teeth.emplace_back(
              ToothField{ tooth, inside.displacement(loads, tooth, cuts.at(tooth)), {} });
          if (const auto of_tooth = field.near->find(tooth); of_tooth != field.near->end())
            {
              added.contact = &of_tooth->second;
              added.without_contact =
                  region.without_contact(added.displacement, loads.at(tooth), *added.contact);
            }
        }
      return field;
    }

    /// A body's file at one of this rank's places.
    struct BodyFile
    {
      Side side;
      Place place;
      const PositionResult *contact;
      TeethLoads loads;
      std::map<int, CutDisplacement> cuts;
    };

    /// A file of each body and place, with the displacements of the teeth's cuts.
    std::vector<BodyFile> body_files(const FinishedRun &run, const std::vector<Place> &places,
                                     const std::vector<int> &teeth)
    {
      std::vector<BodyFile> files;
      for (const Side side : { Side::pinion, Side::gear })
        {
          const std::size_t body = run.bodies.of(side);
          const FlankSurface surface = flank_surface(run.bodies.bodies()[body]->elements().sector());
          std::vector<TeethLoads> loads;
          for (const Place &place : places)
            loads.push_back(flank_loads(surface, run.at[place.torque][place.position], side));
          CutDisplacements cuts = run.bodies.inside(body).cuts(loads, teeth);
          for (std::size_t k = 0; k < places.size(); ++k)
            files.push_back({ .side = side,
                              .place = places[k],
                              .contact = &run.at[places[k].torque][places[k].position],
                              .loads = std::move(loads[k]),
                              .cuts = std::move(cuts[k]) });
        }
      return files;
    }

    void write_bodies(const FieldRequest &request, const FinishedRun &run, const std::vector<Place> &places)
    {
      const std::vector<int> teeth = teeth_around(request.teeth);
      const std::vector<BodyFile> files = body_files(run, places, teeth);
      const std::shared_ptr<const EdgesOfPair> edges = free_edges_of(run.input);
      const std::size_t batch = available_threads(); // no more of them in memory at once
      for (std::size_t first = 0; first < files.size(); first += batch)
        {
          const auto body_of = [&](const BodyFile &file) { return run.bodies.of(file.side); };
          const auto edges_of = [&](const BodyFile &file) {
            return !edges ? nullptr : file.side == Side::pinion ? &edges->pinion : &edges->gear;
          };
          std::vector<LoadedField> moved; // one after the other: a factor answers one thread at a time
          for (std::size_t f = first; f < std::min(first + batch, files.size()); ++f)
            {
              const BodyFile &file = files[f];
              moved.push_back(loaded_field(run.bodies.inside(body_of(file)), run.bodies.region(body_of(file)),
                                           run.bodies.bodies()[body_of(file)]->elements(), edges_of(file),
                                           *file.contact, file.side, file.loads, file.cuts, teeth));
            }
          parallel_for(static_cast<int>(moved.size()), [&](const int m) {
            const BodyFile &file = files[first + m];
            write(run.folder,
                  name_of(run.input, file.place, file.side == Side::pinion ? "pinion" : "gear") + ".vtu",
                  body_field(run.bodies.bodies()[body_of(file)]->elements(), run.bodies.region(body_of(file)),
                             placement_of(run.input.pair, file.side, file.contact->phase), file.side,
                             moved[m].teeth, request.displacement, request.stress));
          });
        }
    }

    const char *const fields_name = "fields";

    /// fields/ of the result folder: VTU files of each position and torque, one PVTU over both bodies, PVD
    /// series over the positions, and a view for ParaView. The ranks take the positions in turn; the files
    /// are the same on any number.
    class Fields : public Extra
    {
    public:
      explicit Fields(FieldRequest request)
          : request_(std::move(request))
      {
      }

      std::string name() const override { return fields_name; }

      void keep(const ParallelAxisCase &, Kept &kept) const override
      {
        kept.cells.insert(request_.positions.begin(), request_.positions.end());
      }

      ExtraPlan plan(const ParallelAxisCase &input) const override
      {
        ExtraPlan plan;
        const std::string places = "at " + counted(request_.positions.size(), "position") + " by " +
                                   counted(request_.torques.size(), "torque");
        if (request_.contact)
          plan.computed.push_back("fields: pressure and gap on the flanks " + places);
        if (request_.in_bodies())
          {
            plan.computed.push_back(
                fmt::format("fields: {} inside {} teeth of each body {}: a tooth sector "
                            "condensed and factored anew, its cuts closed for each load",
                            request_.stress ? request_.displacement ? "displacement and stress" : "stress"
                                            : "displacement",
                            request_.teeth, places));
            plan.left_out.push_back(fmt::format("fields of the other {} and {} teeth (output.field_teeth)",
                                                input.pair.pinion.teeth - request_.teeth,
                                                input.pair.gear.teeth - request_.teeth));
          }
        else
          plan.left_out.push_back(no_fields);
        return plan;
      }

      ExtraCost cost(const ParallelAxisCase &, int) const override
      {
        if (!request_.in_bodies())
          return {};
        return { .inside_bodies = true,
                 .sector_solutions = static_cast<double>(request_.positions.size() * request_.torques.size() *
                                                         static_cast<std::size_t>(request_.teeth)) };
      }

      ExtraOutput compute(const FinishedRun &run) const override
      {
        std::vector<Place> own;
        for (const Place &place : places_of(request_))
          if (place.position % run.work.ranks() == run.work.rank())
            own.push_back(place);
        if (request_.contact)
          for (const Place &place : own)
            write(run.folder, name_of(run.input, place, "contact") + ".vtu",
                  contact_field(run.input.pair, run.at[place.torque][place.position]));
        if (request_.in_bodies() && !own.empty())
          write_bodies(request_, run, own);
        run.work.wait();
        if (run.work.rank() == 0)
          {
            write_series(request_, run.input, run.folder);
            run.folder.write("fields/view.py", field_view);
          }
        return {};
      }

      static constexpr const char *no_fields =
          "stress and displacement inside the bodies: not asked for (output.fields)";

    private:
      FieldRequest request_;
    };
  } // namespace

  ExtraKind fields()
  {
    using namespace keys;
    return {
      .name = fields_name,
      .keys = { texts("output.fields", "none",
                      "what is written for ParaView: nothing is computed for what is not listed",
                      { "displacement", "stress", "contact" }),
                numbers("output.field_positions", 0, 4095, "0",
                        "mesh positions of the fields, counted from 0, of the first mesh cycle"),
                numbers("output.field_torques_Nm", 0, 1e9, "the greatest",
                        "torques of the fields, of those computed [N m]"),
                integer("output.field_teeth", 1, 999, "5",
                        "teeth of each body in the fields, odd; the middle one meets at the pitch point") },
      .files = {},
      .left_out = Fields::no_fields,
      .in_studies = false,
      .asked = [](const CaseFile &file, const ParallelAxisCase &input) -> std::shared_ptr<const Extra> {
        FieldRequest request = field_request(file, input);
        if (!request.any())
          return nullptr;
        return std::make_shared<Fields>(std::move(request));
      }
    };
  }
} // namespace flank
