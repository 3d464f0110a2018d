// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/fields/loaded_teeth.hpp"

#include "solver/linear/direct_solver.hpp"

namespace flank
{
  namespace
  {
    std::vector<char> bore_and_cuts(const ToothSector &sector, const ElasticBody &body)
    {
      std::vector<char> held = bore_unknowns(sector, body);
      for (const bool plus : { true, false })
        for (const int node : cut_nodes(sector, body, plus))
          std::fill_n(held.begin() + 3 * node, 3, 1);
      return held;
    }
  } // namespace

  struct LoadedTeeth::Implementation
  {
    Implementation(const BodyElements &elements, const BodyModel &model)
        : elements(elements)
        , model(model)
        , condensed(condense_sector(elements.sector(), elements.body(), MidPlane::none, 0, nullptr))
        , inside(make_direct_solver(elements.body().stiffness(), bore_and_cuts(elements.sector(), elements.body())))
    {
    }
    const BodyElements                 &elements;
    BodyModel                           model;
    CondensedSector                     condensed;
    std::unique_ptr<const DirectSolver> inside;
  };

  LoadedTeeth::LoadedTeeth(const BodyElements &elements, const BodyModel &model)
      : implementation_(std::make_unique<Implementation>(elements, model))
  {
  }

  LoadedTeeth::~LoadedTeeth() = default;

  CutDisplacements LoadedTeeth::cuts(const std::vector<TeethLoads> &loads, const std::vector<int> &wanted) const
  {
    const auto &own  = *implementation_;
    const Gear &gear = own.elements.sector().gear;
    return own.model.kind == BodyModel::Kind::ring ? ring_cuts(own.condensed, gear.teeth, loads, wanted)
                                                   : segment_cuts(own.condensed, own.model, gear.pitch_angle(), loads, wanted);
  }

  Eigen::VectorXd LoadedTeeth::displacement(const TeethLoads &loads, const int tooth, const CutDisplacement &cut) const
  {
    const auto        &own    = *implementation_;
    const ToothSector &sector = own.elements.sector();
    const ElasticBody &body   = own.elements.body();
    Eigen::VectorXd    load = Eigen::VectorXd::Zero(body.n_unknowns()), held = load;
    const auto         hold = [&](const bool plus, const Eigen::VectorXd &values) {
      Eigen::Index i = 0;
      for (const int node : cut_nodes(sector, body, plus))
        held.segment<3>(3 * node) = values.segment<3>(3 * i++);
    };
    hold(false, cut.minus);
    hold(true, cut.plus);
    if (const auto of_tooth = loads.find(tooth); of_tooth != loads.end())
      {
        const FlankSurface     surface = flank_surface(sector);
        const Eigen::Matrix3Xd normals = flank_normals(sector, surface);
        const auto             flank   = flank_nodes(sector, surface, body);
        for (Eigen::Index i = 0; i < normals.cols(); ++i)
          load.segment<3>(3 * flank[i]) += of_tooth->second[i] * normals.col(i);
      }
    return own.inside->solve(load, held);
  }

  std::vector<Eigen::VectorXd> LoadedTeeth::displacements(const TeethLoads &loads, const std::vector<int> &wanted) const
  {
    const auto                   of_teeth = cuts({ loads }, wanted).front();
    std::vector<Eigen::VectorXd> result;
    for (const int tooth : wanted)
      result.push_back(displacement(loads, tooth, of_teeth.at(tooth)));
    return result;
  }
} // namespace flank
