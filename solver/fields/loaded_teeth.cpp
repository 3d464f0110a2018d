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
        , inside(elements.body().stiffness(), bore_and_cuts(elements.sector(), elements.body()))
    {
    }
    const BodyElements &elements;
    BodyModel           model;
    CondensedSector     condensed;
    DirectSolver        inside;
  };

  LoadedTeeth::LoadedTeeth(const BodyElements &elements, const BodyModel &model)
      : implementation_(std::make_unique<Implementation>(elements, model))
  {
  }

  LoadedTeeth::~LoadedTeeth() = default;

  std::vector<std::vector<Eigen::VectorXd>> LoadedTeeth::displacements(const std::vector<TeethLoads> &loads,
                                                                       const std::vector<int>        &wanted) const
  {
    const auto            &own     = *implementation_;
    const ToothSector     &sector  = own.elements.sector();
    const ElasticBody     &body    = own.elements.body();
    const FlankSurface     surface = flank_surface(sector);
    const Eigen::Matrix3Xd normals = flank_normals(sector, surface);
    const auto flank = flank_nodes(sector, surface, body), minus = cut_nodes(sector, body, false), plus = cut_nodes(sector, body, true);
    const CutDisplacements                    cuts = own.model.kind == BodyModel::Kind::ring
                                                         ? ring_cuts(own.condensed, sector.gear.teeth, loads, wanted)
                                                         : segment_cuts(own.condensed, own.model, sector.gear.pitch_angle(), loads, wanted);
    std::vector<std::vector<Eigen::VectorXd>> result(loads.size());
    for (std::size_t k = 0; k < loads.size(); ++k)
      for (const int tooth : wanted)
        {
          Eigen::VectorXd        load = Eigen::VectorXd::Zero(body.n_unknowns()), held = load;
          const CutDisplacement &cut = cuts[k].at(tooth);
          for (std::size_t i = 0; i < minus.size(); ++i)
            {
              held.segment<3>(3 * minus[i]) = cut.minus.segment<3>(3 * static_cast<Eigen::Index>(i));
              held.segment<3>(3 * plus[i])  = cut.plus.segment<3>(3 * static_cast<Eigen::Index>(i));
            }
          if (const auto of_tooth = loads[k].find(tooth); of_tooth != loads[k].end())
            for (Eigen::Index i = 0; i < normals.cols(); ++i)
              load.segment<3>(3 * flank[i]) += of_tooth->second[i] * normals.col(i);
          result[k].push_back(own.inside.solve(load, held));
        }
    return result;
  }
} // namespace flank
