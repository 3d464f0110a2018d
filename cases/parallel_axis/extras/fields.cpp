// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/field_files.hpp"

#include "cases/parallel_axis/extras/solved_contact.hpp"
#include "cases/results/field_view.hpp"
#include "contact/stress/body_field.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>

namespace flank
{
  namespace
  {
    /// One position at one torque: an index among the case's.
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
    void write_series(const ParallelAxisCase &input, const ResultFolder &folder)
    {
      const FieldRequest &request = input.fields;
      const auto          series  = [&](const char *what, const int torque, const std::string &ending) {
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

    /// The teeth of one body at one place, with the half-space's loads that some of them point to.
    struct LoadedField
    {
      std::unique_ptr<const std::map<int, HalfSpaceLoads>> half_space;
      std::vector<ToothField>                              teeth;
    };

    LoadedField loaded_field(const LoadedTeeth &inside, const ContactRegion &region,
                             const BodyElements &elements, const PositionResult &contact, const Side side,
                             const TeethLoads &loads, const std::map<int, CutDisplacement> &cuts,
                             const std::vector<int> &teeth)
    {
      LoadedField field;
      field.half_space = std::make_unique<const std::map<int, HalfSpaceLoads>>(
          half_space_loads(elements.sector().gear, flank_surface(elements.sector()), contact, side));
      for (const int tooth : teeth)
        {
          ToothField &added = field.teeth.emplace_back(
              ToothField{ tooth, inside.displacement(loads, tooth, cuts.at(tooth)), {} });
          if (const auto of_tooth = field.half_space->find(tooth); of_tooth != field.half_space->end())
            {
              added.contact = &of_tooth->second;
              added.without_contact =
                  region.without_contact(added.displacement, loads.at(tooth), *added.contact);
            }
        }
      return field;
    }
  } // namespace

  void write_fields(const ParallelAxisCase &input, LoadedBodies &bodies, const ResultFolder &folder,
                    const ParallelSession &session)
  {
    const FieldRequest &request = input.fields;
    if (!request.any())
      return;
    const LoadedPair   mesh = mesh_with_cells(input, bodies.bodies());
    std::vector<Place> own;
    for (const Place &place : places_of(request))
      if (place.position % session.ranks() == session.rank())
        own.push_back(place);
    std::vector<PositionResult> contact(own.size());
    parallel_for(static_cast<int>(own.size()), [&](const int k) {
      contact[k] = solved_contact(input, mesh, own[k].position, { own[k].torque }).at(own[k].torque);
    });
    if (request.contact)
      for (std::size_t k = 0; k < own.size(); ++k)
        write(folder, name_of(input, own[k], "contact") + ".vtu", contact_field(input.pair, contact[k]));

    const std::vector<int> teeth = teeth_around(request.teeth);
    if (request.in_bodies() && !own.empty())
      {
        struct File
        {
          Side                           side;
          std::size_t                    of; ///< among this rank's places
          const TeethLoads              *loads;
          std::map<int, CutDisplacement> cuts;
        };
        std::map<Side, std::vector<TeethLoads>> loads;
        std::vector<File>                       files;
        for (const Side side : { Side::pinion, Side::gear })
          {
            const FlankSurface surface = flank_surface(bodies.bodies()[bodies.of(side)]->elements().sector());
            for (const PositionResult &result : contact)
              loads[side].push_back(flank_loads(surface, result, side));
            CutDisplacements cuts = bodies.inside(bodies.of(side)).cuts(loads[side], teeth);
            for (std::size_t k = 0; k < own.size(); ++k)
              files.push_back({ side, k, &loads[side][k], std::move(cuts[k]) });
          }
        const std::size_t batch = available_threads(); // no more of them in memory at once
        for (std::size_t first = 0; first < files.size(); first += batch)
          {
            const auto number = [&](const std::size_t file) { return bodies.of(files[file].side); };
            std::vector<LoadedField> moved; // one after the other: a factor answers one thread at a time
            for (std::size_t f = first; f < std::min(first + batch, files.size()); ++f)
              moved.push_back(loaded_field(bodies.inside(number(f)), bodies.region(number(f)),
                                           bodies.bodies()[number(f)]->elements(), contact[files[f].of],
                                           files[f].side, *files[f].loads, files[f].cuts, teeth));
            parallel_for(static_cast<int>(moved.size()), [&](const int m) {
              const File &file = files[first + m];
              write(folder,
                    name_of(input, own[file.of], file.side == Side::pinion ? "pinion" : "gear") + ".vtu",
                    body_field(bodies.bodies()[number(first + m)]->elements(),
                               bodies.region(number(first + m)),
                               placement_of(input.pair, file.side, contact[file.of].phase), file.side,
                               moved[m].teeth, request.displacement, request.stress));
            });
          }
      }
    session.wait();
    if (session.rank() == 0)
      {
        write_series(input, folder);
        folder.write("fields/view.py", field_view);
      }
  }
} // namespace flank
