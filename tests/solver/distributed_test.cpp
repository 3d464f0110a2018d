// SPDX-License-Identifier: GPL-2.0-or-later
// Run on several ranks: the operator that all of them make together is the one that a process makes alone.
#include "solver/parallel_session.hpp"
#include "solver/reduction/flank_compliance.hpp"
#include "tests/example_pairs.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>

using namespace flank;

namespace
{
  const ParallelSession *session;

  class Distributed : public testing::TestWithParam<std::tuple<double, BodyModel::Kind>>
  {
  };
} // namespace

TEST(Partition, MetisGivesEveryRankAnEqualShare)
{
  SectorResolution size;
  const BodyElements elements(make_gear_pair(twelve_tooth_pair(20)).pinion, size);
  for (const int parts : { 1, 2, 5 })
    {
      const std::vector<int> part = elements.body().partition(parts);
      for (int p = 0; p < parts; ++p)
        EXPECT_NEAR(1.0 * std::count(part.begin(), part.end(), p) * parts / static_cast<double>(part.size()),
                    1, 0.1);
    }
}

TEST(SharedBytes, EveryRankReadsWhatOneHas)
{
  std::vector<SharedBytes> shared;
  for (int from = 0; from < session->ranks(); ++from)
    {
      std::vector<char> bytes;
      if (session->rank() == from)
        for (int i = 0; i < 3000000; ++i)
          bytes.push_back(static_cast<char>(i * 7 % 251));
      shared.push_back(session->share(SharedBytes(std::move(bytes)), from));
    }
  for (const SharedBytes &s : shared)
    {
      ASSERT_EQ(s.size, 3000000u);
      int wrong = 0;
      for (int i = 0; i < 3000000; ++i)
        wrong += s.data[i] != static_cast<char>(i * 7 % 251);
      EXPECT_EQ(wrong, 0);
    }
  session->wait();
  for (const auto &entry : std::filesystem::directory_iterator("/dev/shm"))
    EXPECT_NE(entry.path().filename().string().rfind("flank-" + std::to_string(getpid()) + "-", 0), 0u)
        << entry.path(); // nothing stays
}

TEST_P(Distributed, OperatorIsThatOfOneProcess)
{
  const auto [helix, kind] = GetParam();
  SectorResolution size;
  size.flank_rows = 5, size.tooth_columns = 4, size.face_layers = 4, size.rim_layers = 3;
  const BodyElements elements(make_gear_pair(twelve_tooth_pair(helix)).pinion, size);
  BodyModel model;
  model.kind = kind, model.segment_teeth = 5;
  for (const int depth : { 0, 1 })
    {
      model.reduction = BodyModel::Reduction::distributed;
      const FlankCompliance together = flank_compliance(elements, model, 3, depth, session); // collective
      if (session->rank() != 0)
        {
          EXPECT_TRUE(together.by_tooth_offset.empty());
          continue;
        }
      model.reduction = BodyModel::Reduction::condensed;
      const FlankCompliance alone = flank_compliance(elements, model, 3, depth);
      ASSERT_EQ(together.by_tooth_offset.size(), 4u);
      const double scale = alone.by_tooth_offset[0].cwiseAbs().maxCoeff();
      for (std::size_t m = 0; m < 4; ++m)
        EXPECT_LT((together.by_tooth_offset[m] - alone.by_tooth_offset[m]).cwiseAbs().maxCoeff(),
                  1e-8 * scale);
      for (std::size_t d = 0; d < alone.by_depth.size(); ++d)
        EXPECT_LT((together.by_depth[d] - alone.by_depth[d]).cwiseAbs().maxCoeff(), 1e-8 * scale);
    }
}
INSTANTIATE_TEST_SUITE_P(Models, Distributed,
                         testing::Combine(testing::Values(0.0, 20.0),
                                          testing::Values(BodyModel::Kind::ring, BodyModel::Kind::segment)));

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const ParallelSession ranks(argc, argv);
  session = &ranks;
  return RUN_ALL_TESTS();
}
