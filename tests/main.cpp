// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/parallel_session.hpp"

#include <gtest/gtest.h>

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const flank::ParallelSession session(argc, argv);
  return RUN_ALL_TESTS();
}
