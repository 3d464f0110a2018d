// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/fields/loaded_teeth.hpp"

namespace flank
{
  struct LoadedTeeth::Implementation
  {
    Implementation(const BodyElements &elements, const BodyModel &model)
        : elements(elements)
        , model(model)
        , condensed(condense_sector(elements.sector(), elements.body(), MidPlane::none, 0, nullptr, &inside))
    {
    }
    const BodyElements &elements;
    BodyModel model;
    SectorInside inside; // before what fills it
    CondensedSector condensed;
  };

  LoadedTeeth::LoadedTeeth(const BodyElements &elements, const BodyModel &model)
      : implementation_(std::make_unique<Implementation>(elements, model))
  {
  }

  LoadedTeeth::~LoadedTeeth() = default;

  CutDisplacements LoadedTeeth::cuts(const std::vector<TeethLoads> &loads,
                                     const std::vector<int> &wanted) const
  {
    const auto &own = *implementation_;
    const Gear &gear = own.elements.sector().gear;
    return own.model.kind == BodyModel::Kind::ring
               ? ring_cuts(own.condensed, gear.teeth, loads, wanted)
               : segment_cuts(own.condensed, own.model, gear.pitch_angle(), loads, wanted);
  }

  Eigen::VectorXd LoadedTeeth::displacement(const TeethLoads &loads, const int tooth,
                                            const CutDisplacement &cut) const
  {
    const auto &own = *implementation_;
    const ToothSector &sector = own.elements.sector();
    const ElasticBody &body = own.elements.body();
    Eigen::VectorXd held = Eigen::VectorXd::Zero(body.n_unknowns());
    const auto hold = [&](const bool plus, const Eigen::VectorXd &values) {
      Eigen::Index i = 0;
      for (const int node : cut_nodes(sector, body, plus))
        held.segment<3>(3 * node) = values.segment<3>(3 * i++);
    };
    hold(false, cut.minus);
    hold(true, cut.plus);
    // The flank's normal displacements, by the very matrices that the compliance comes from.
    Eigen::VectorXd normal = own.condensed.output_plus * turned(cut.plus, -sector.gear.pitch_angle()) +
                             own.condensed.output_minus * cut.minus;
    if (const auto of_tooth = loads.find(tooth); of_tooth != loads.end())
      normal += own.condensed.own * of_tooth->second;
    const std::vector<int> flank = flank_nodes(sector, flank_surface(sector), body);
    for (std::size_t i = 0; i < flank.size(); ++i)
      held[3 * flank[i]] = normal[static_cast<Eigen::Index>(i)];
    Eigen::VectorXd result = own.inside.solver->solve(Eigen::VectorXd::Zero(held.size()), held);
    for (const auto &[node, axes] : own.inside.axes)
      result.segment<3>(3 * node) = (axes * result.segment<3>(3 * node)).eval();
    return result;
  }
} // namespace flank
