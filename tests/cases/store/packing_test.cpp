// SPDX-License-Identifier: GPL-2.0-or-later
// Records as bytes.
#include "cases/work/packing.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace flank;

TEST(Packing, HostileCountsAreRefused)
{
  // As many entries as no bytes are left for, a negative number of them, a matrix of 2^61 x 8 numbers (whose
  // product runs over).
  for (const std::int64_t count : { std::int64_t{ -1 }, std::int64_t{ 4 }, std::int64_t{ 1 } << 61,
                                    std::numeric_limits<std::int64_t>::max() })
    {
      Packer out;
      out.value(count);
      out.value(1.0), out.value(2.0), out.value(3.0);
      Unpacker list(out.result), shapes(out.result);
      EXPECT_THROW(list.values<double>(), UnusableRecord) << count;
    }
  for (const auto &[rows, columns] : { std::pair<std::int64_t, std::int64_t>{ std::int64_t{ 1 } << 61, 8 },
                                       { 8, std::int64_t{ 1 } << 61 },
                                       { -1, -1 },
                                       { 2, 1000 } })
    {
      Packer out;
      out.value(rows), out.value(columns);
      out.values(std::vector<double>(30, 1.0));
      Unpacker in(out.result);
      EXPECT_THROW(in.matrix(), UnusableRecord) << rows << " x " << columns;
    }
  const std::vector<char> nothing;
  Unpacker in(nothing);
  EXPECT_THROW(in.value<double>(), UnusableRecord);
}

TEST(Packing, OneListOfFieldsServesBothWays)
{
  struct Record
  {
    int number = 0;
    bool flag = false;
    std::string text;
    std::vector<double> values;
    Eigen::VectorXd vector;
    Eigen::Matrix3Xd places;
    std::vector<std::string> texts;
  };
  const auto fields = [](auto &archive, auto &r) {
    archive.fields(r.number, r.flag, r.text, r.values, r.vector, r.places);
    archive.list(r.texts, [](auto &to, auto &text) { to.fields(text); });
  };
  const Record record{
    7, true, "a, b", { 1, 2.5 }, Eigen::Vector3d(1, 2, 3), Eigen::Matrix3d::Identity(), { "", "c" }
  };
  Packer out;
  fields(out, record);
  Record read;
  Unpacker in(out.result);
  fields(in, read);
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(std::tie(read.number, read.flag, read.text, read.values, read.texts),
            std::tie(record.number, record.flag, record.text, record.values, record.texts));
  EXPECT_EQ(read.vector, record.vector);
  EXPECT_EQ(read.places, record.places);

  // A list's number of entries is that of what can be read, and a matrix has the rows that its field has.
  for (const int count : { 1 << 30, 3, -1 })
    {
      Packer hostile;
      hostile.value(count);
      std::vector<std::string> texts;
      Unpacker from(hostile.result);
      EXPECT_THROW(from.list(texts, [](auto &to, auto &text) { to.fields(text); }), UnusableRecord) << count;
    }
  Packer wide;
  wide.matrix(Eigen::MatrixXd::Ones(2, 4));
  Unpacker from(wide.result);
  EXPECT_THROW(from.fields(read.places), UnusableRecord);
}
