// The readers of CalculiX's files on small made-up ones, whole and cut off.

#include "fem_reference/calculix/result_files.hpp"

#include "scene/errors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace concord::calculix {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string dat = R"(
 displacements (vx,vy,vz) for set NALL and time  0.5000000E+00

         1  0.000000E+00 -1.250000E-03  0.000000E+00
         2  1.000000E-01  2.500000-101  0.000000E+00

 total force (fx,fy,fz) for set R10 and time  0.5000000E+00

        1.170406E-14  6.346154E+01 -1.249001E-15

 equivalent plastic strain (elem, integ.pnt.,pe)for set EALL and time  0.5000000E+00

         1   1  1.500000E-02
         1   2  2.500000E-02
)";

std::vector<DatTable> tables_of(const std::string& text) {
  std::istringstream file(text);
  std::vector<DatTable> tables;
  read_dat(file, [&](const DatTable& table) { tables.push_back(table); });
  return tables;
}

TEST(DatFile, ReadsTablesWithTheirSetsAndTimes) {
  const auto tables = tables_of(dat);
  ASSERT_EQ(tables.size(), 3u);
  EXPECT_EQ(tables[0].quantity, "displacements");
  EXPECT_EQ(tables[0].set, "NALL");
  EXPECT_EQ(tables[0].time, 0.5);
  EXPECT_EQ(tables[0].rows(), 2u);
  EXPECT_THAT(tables[0].values, ElementsAre(1, 0, -1.25e-3, 0, 2, 0.1, 2.5e-101, 0));
  EXPECT_EQ(tables[1].quantity, "total force");
  EXPECT_EQ(tables[1].set, "R10");
  EXPECT_EQ(tables[1].values[1], 63.46154);
  EXPECT_EQ(tables[2].quantity, "equivalent plastic strain");
  EXPECT_EQ(tables[2].columns, 3u);
  EXPECT_EQ(tables[2].values[5], 0.025);
}

TEST(DatFile, ARowThatIsCutOffIsLeftOut) {
  // Whatever the length of what was written, no row is half a row and no number half a number.
  for (std::size_t length = 0; length <= dat.size(); ++length) {
    for (const DatTable& table : tables_of(dat.substr(0, length))) {
      if (table.columns == 0) continue;
      ASSERT_EQ(table.values.size() % table.columns, 0u) << length;
      if (table.quantity == "displacements" && table.rows() > 1) {
        ASSERT_EQ(table.values[6], 2.5e-101) << length;
      }
    }
  }
}

TEST(DatFile, SaysTheLineThatIsNoTable) {
  for (const std::string& bad :
       {"  what is this\n" + dat, dat + "   3  4.0\n", dat + "         1   3  1.5000oops\n"}) {
    try {
      tables_of(bad);
      ADD_FAILURE() << bad;
    } catch (const SolveError& error) {
      EXPECT_THAT(error.what(), HasSubstr(".dat file, line "));
    }
  }
}

const std::string frd = R"(    1C
    1UUSER
    1PSTEP                         1           1           1
    2C                             2                                     1
 -1         1 0.00000E+00 0.00000E+00 0.00000E+00
 -1         2 1.00000E+00 0.00000E+00 0.00000E+00
 -3
    1PSTEP                         1           1           1
  100CL  101 2.00000E-02           2                     0    1           1
 -4  DISP        4    1
 -5  D1          1    2    1    0
 -5  D2          1    2    2    0
 -5  D3          1    2    3    0
 -5  ALL         1    2    0    0    1ALL
 -1         1 0.00000E+00-1.00000E-03 0.00000E+00
 -1         2-4.60608E-02 1.00000E-01 0.00000E+00
 -3
    1PSTEP                         2           1           1
  100CL  102 1.000000000           2                     0    2           1
 -4  PE          1    1
 -5  PE          1    1    0    0
 -1         1 1.25000E-02
 -1         2 2.50000E-02
 -3
 9999
)";

std::vector<FrdBlock> blocks_of(const std::string& text) {
  std::istringstream file(text);
  std::vector<FrdBlock> blocks;
  read_frd(file, [&](const FrdBlock& block) { blocks.push_back(block); });
  return blocks;
}

TEST(FrdFile, ReadsFieldsAtNodes) {
  const auto blocks = blocks_of(frd);
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].name, "DISP");
  EXPECT_EQ(blocks[0].time, 0.02);
  EXPECT_EQ(blocks[0].components, 3u);
  EXPECT_THAT(blocks[0].nodes, ElementsAre(1, 2));
  EXPECT_THAT(blocks[0].values, ElementsAre(0, -1e-3, 0, -4.60608e-2, 0.1, 0));
  EXPECT_EQ(blocks[1].name, "PE");
  EXPECT_EQ(blocks[1].time, 1);
  EXPECT_THAT(blocks[1].values, ElementsAre(0.0125, 0.025));
}

TEST(FrdFile, ABlockThatIsCutOffIsLeftOut) {
  const std::size_t first_whole = frd.find("    1PSTEP                         2");
  const std::size_t second_whole = frd.find(" 9999");
  for (std::size_t length = 0; length <= frd.size(); ++length) {
    const std::size_t whole =
        (length >= first_whole ? 1 : 0) + (length >= second_whole ? 1 : 0);
    ASSERT_EQ(blocks_of(frd.substr(0, length)).size(), whole) << length;
  }
}

TEST(FrdFile, SaysTheLineThatIsNoRow) {
  std::string bad = frd;
  bad.replace(bad.find("-4.60608E-02"), 12, "-4.60608oops");
  try {
    blocks_of(bad);
    ADD_FAILURE();
  } catch (const SolveError& error) {
    EXPECT_THAT(error.what(), HasSubstr(".frd file, line 16"));
  }
}

TEST(StaFile, CountsConvergedIncrements) {
  std::istringstream file(R"(SUMMARY OF JOB INFORMATION
  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME
     1          1     1     2  0.200000E-01  0.200000E-01  0.200000E-01
     1          2     1U   16  0.400000E-01  0.400000E-01  0.200000E-01
     1          2     2     5  0.250000E-01  0.250000E-01  0.500000E-02
)");
  const Progress progress = read_sta(file);
  EXPECT_EQ(progress.increments, 2);
  EXPECT_EQ(progress.iterations, 7);
  EXPECT_EQ(progress.time, 0.025);
}

}  // namespace
}  // namespace concord::calculix
