// `concord probe` as a user meets it: what it writes, and what it says to bad input.

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;

namespace {

class ProbeCommand : public testing::Test {
 protected:
  void SetUp() override {
    m_work = fs::path(testing::TempDir()) / ("concord-probe-" + std::to_string(::getpid()));
    fs::create_directories(m_work);
  }
  void TearDown() override { fs::remove_all(m_work); }

  int run(const std::string& arguments) {
    const int status = std::system(
        ("cd '" + m_work.string() + "' && '" CONCORD_PROGRAM "' " + arguments + " >out 2>err")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string read(const std::string& name) const {
    std::ifstream stream(m_work / name);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  void expect_bad_input(const std::string& arguments, const std::string& mentions) {
    EXPECT_EQ(run(arguments), 2) << arguments;
    const std::string said = read("err");
    EXPECT_NE(said.find(mentions), std::string::npos) << said;
    EXPECT_NE(said.find("allowed"), std::string::npos) << said;
  }

  fs::path m_work;
};

TEST_F(ProbeCommand, WritesASummaryWithItsNameAndOptions) {
  ASSERT_EQ(run("probe checkerboard spinning_block --method delaunay --set delaunay.xi_n=0.5 "
                "--resolution 3 --option stretch=0.9 --out here"),
            0)
      << read("err");
  const auto summary = nlohmann::json::parse(read("here/summary.json"));
  EXPECT_EQ(summary.at("probe"), "checkerboard");
  EXPECT_EQ(summary.at("method"), "delaunay");
  EXPECT_EQ(summary.at("variant"), "xi_n=0.5");
  EXPECT_EQ(summary.at("options").at("stretch"), "0.9");
  EXPECT_EQ(summary.at("options").at("shear"), "0");
  EXPECT_EQ(summary.at("particles"), 64);
  EXPECT_GT(summary.at("quantities").at("restoring"), 0);
}

TEST_F(ProbeCommand, AFailureOfTheMethodIsAResultOfReach) {
  ASSERT_EQ(run("probe reach compressed_block --method delaunay --resolution 2 "
                "--set parameters.compression=1.5 --out here"),
            0)
      << read("err");
  const auto summary = nlohmann::json::parse(read("here/summary.json"));
  EXPECT_LT(summary.at("quantities").at("reached"), 1);
  EXPECT_EQ(summary.at("quantities").at("clean"), 1);
  EXPECT_FALSE(summary.contains("error"));
  EXPECT_FALSE(summary.at("notes").at("failure").get<std::string>().empty());
}

TEST_F(ProbeCommand, TellsWhatIsWrong) {
  expect_bad_input("probe spectra spinning_block --method delaunay", "spectrum");
  expect_bad_input("probe spectrum spinning_block", "--method");
  expect_bad_input("probe spectrum nowhere --method delaunay", "nowhere");
  expect_bad_input("probe spectrum spinning_block --method lattice", "delaunay");
  expect_bad_input("probe spectrum spinning_block --method delaunay --option lowest=3",
                   "spectrum.lowest");
  expect_bad_input("probe spectrum spinning_block --method delaunay --option low=soft", "low");
  expect_bad_input("probe spectrum spinning_block --method delaunay --option low", "--option");
  expect_bad_input("probe spectrum spinning_block --method delaunay --resolution 40",
                   "unknowns");
  expect_bad_input("probe spectrum spinning_block --method delaunay --set tlsph.psi=1",
                   "tlsph");
  expect_bad_input("probe reach spinning_block --method delaunay", "static");
  expect_bad_input("probe energy_drift cooks_membrane --method delaunay", "dynamic");
  expect_bad_input("probe rotation cooks_membrane --method delaunay", "spin");
  expect_bad_input("probe stable_step spinning_block --method delaunay --option "
                   "arrangements=2 --option spacing=log --option perturb_from=0 --perturb 0.1",
                   "perturb_from");
  expect_bad_input("probe locking cooks_membrane --method delaunay --resolution 2 --option "
                   "quantity=top",
                   "tip_y");
  expect_bad_input("probe placement cooks_membrane --method delaunay --resolution 2 --option "
                   "quantity=tip",
                   "quantities.tip_y");
}

TEST_F(ProbeCommand, IsListedAndDescribed) {
  ASSERT_EQ(run("list probes --json"), 0);
  const auto list = nlohmann::json::parse(read("out")).at("probes");
  ASSERT_GE(list.size(), 8U);
  for (const auto& probe : list) {
    const auto name = probe.at("name").get<std::string>();
    EXPECT_FALSE(probe.at("title").get<std::string>().empty()) << name;
    EXPECT_FALSE(probe.at("source").get<std::string>().empty()) << name;
    ASSERT_EQ(run("describe " + name), 0) << name;
    EXPECT_NE(read("out").find("quantities:"), std::string::npos);
  }
}

}  // namespace
