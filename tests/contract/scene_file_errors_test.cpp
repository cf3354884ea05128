// Every way in which a scene file can be wrong: where the message points and what it says.

#include "tests/contract/expect_input_error.hpp"

using namespace concord;
using namespace concord::test;

namespace {

/// The plane scene with one text replaced.
std::string with(const std::string& old, const std::string& replacement,
                 const std::string& more = "", const std::string& top = "") {
  std::string text = plane_scene(more, top);
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), replacement);
}

const std::string fixed_x0 = "[[boundary]]\ngroup = \"x0\"\nkind = \"fixed\"\n";

}  // namespace

TEST(SceneFile, SyntaxError) {
  expect_scene_error("dimension = \n", {"", "syntax", "", "TOML"});
  expect_scene_error("title = \"a\"\ntitle = \"b\"\n", {"", "syntax", "", "TOML"});
}

TEST(SceneFile, MissingFileNamesTheLibrary) {
  expect_input_error("", {"", "scene", "swinging_cub", "did you mean swinging_cube?"},
                     [] { (void)scene::read_problem("swinging_cub"); });
}

TEST(SceneFile, UnknownKeys) {
  expect_scene_error(plane_scene("", "end_tme = \"1 s\"\n"),
                     {"end_tme", "end_tme", "unknown", "did you mean end_time?"});
  expect_scene_error(
      with("youngs_modulus", "young_modulus"),
      {"young_modulus", "material.young_modulus", "unknown", "did you mean youngs_modulus?"});
  expect_scene_error(plane_scene(fixed_x0 + "knd = 1\n"),
                     {"knd", "boundary.0.knd", "unknown", "kind"});
  expect_scene_error(plane_scene("[metarial]\na = 1\n"),
                     {"metarial]", "metarial", "unknown", "material"});
}

TEST(SceneFile, KeysWithoutMeaningHere) {
  expect_scene_error(plane_scene("", "load_steps = 3\n"),
                     {"load_steps", "load_steps", "no meaning", "without it"});
  expect_scene_error(plane_scene(fixed_x0 + "value = [\"0\", \"0\"]\n"),
                     {"value", "boundary.0.value", "no meaning", "without it"});
  expect_scene_error(with("\"plane strain\"", "\"3D\"", "", "thickness = \"1 m\"\n"),
                     {"thickness", "thickness", "no meaning", "without it"});
}

TEST(SceneFile, MissingKeys) {
  expect_scene_error(with("dimension = \"plane strain\"\n", ""),
                     {"", "dimension", "nothing", "3D | plane strain | plane stress"});
  expect_scene_error(with("density = \"1000 kg/m^3\"\n", ""),
                     {"[material]", "material.density", "nothing", "> 0"});
  expect_scene_error(with("end_time = \"1 ms\"\n", ""),
                     {"", "end_time", "nothing", "static = true"});
  expect_scene_error(plane_scene("[[boundary]]\nkind = \"fixed\"\n"),
                     {"[[boundary]]", "boundary.0.group", "nothing", "physical group"});
}

TEST(SceneFile, WrongTypes) {
  expect_scene_error(with("\"plane strain\"", "3"), {"3", "dimension", "the number 3", "text"});
  expect_scene_error(with("poissons_ratio = 0.3", "poissons_ratio = \"0.3\""),
                     {"\"0.3\"", "material.poissons_ratio", "0.3", "a number without quotes"});
  expect_scene_error(plane_scene("[output]\nframes = 1.5\n"),
                     {"1.5", "output.frames", "1.5", "a whole number"});
  expect_scene_error(plane_scene("[output]\nframes = -1\n"),
                     {"-1", "output.frames", "-1", "from 0"});
  expect_scene_error(plane_scene("", "boundary = \"x\"\n"),
                     {"\"x\"", "boundary", "\"x\"", "[[boundary]]"});
  expect_scene_error(plane_scene("", "static = 1\n"),
                     {"1\n[mat", "static", "1", "true | false"});
}

TEST(SceneFile, UnitsAndRanges) {
  expect_scene_error(with("\"1 MPa\"", "1e6"),
                     {"1e6", "material.youngs_modulus", "without a unit", "17 MPa"});
  expect_scene_error(with("\"1 MPa\"", "\"1 m\""),
                     {"\"1 m\"\np", "material.youngs_modulus", "a length", "unit of stress"});
  expect_scene_error(with("\"1 MPa\"", "\"1 MPx\""),
                     {"\"1 MPx\"", "material.youngs_modulus", "\"MPx\" is unknown", "stress"});
  expect_scene_error(with("\"1000 kg/m^3\"", "\"-5 kg/m^3\""),
                     {"\"-5 kg/m^3\"", "material.density", "-5", "> 0"});
  for (const char* nu : {"0.5", "-1.0", "0.7", "nan", "inf"})
    expect_scene_error(with("= 0.3", std::string("= ") + nu),
                       {nu, "material.poissons_ratio", "", "-1 < nu < 0.5"});
  expect_scene_error(with("\"1 ms\"", "\"0 s\""), {"\"0 s\"", "end_time", "0 s", "> 0"});
  expect_scene_error(with("reference_length = \"1 m\"", "reference_length = \"-1 m\""),
                     {"\"-1 m\"", "reference_length", "-1 m", "> 0"});
  expect_scene_error(plane_scene("", "gravity = [\"0 m/s^2\", \"9.81 m/s\"]\n"),
                     {"\"9.81 m/s\"", "gravity.1", "a velocity", "acceleration"});
}

TEST(SceneFile, WordsWithSuggestions) {
  expect_scene_error(
      with("neo-hookean", "neo-hokean"),
      {"\"neo-hokean\"", "material.model", "neo-hokean", "did you mean neo-hookean?"});
  expect_scene_error(plane_scene("[[boundary]]\ngroup = \"x0\"\nkind = \"fixd\"\n"),
                     {"\"fixd\"", "boundary.0.kind", "fixd", "did you mean fixed?"});
  expect_scene_error(with("plane strain", "plane stain"),
                     {"\"plane stain\"", "dimension", "stain", "did you mean plane strain?"});
}

TEST(SceneFile, ElasticConstantsComeInPairs) {
  expect_scene_error(
      with("poissons_ratio = 0.3\n", ""),
      {"[material]", "material", "no pair", "youngs_modulus with poissons_ratio"});
  expect_scene_error(
      with("poissons_ratio", "shear_modulus = \"1 Pa\"\npoissons_ratio"),
      {"[material]", "material", "no pair", "youngs_modulus with poissons_ratio"});
}

TEST(SceneFile, HardeningOfPlasticMaterials) {
  const std::string ratio = "poissons_ratio = 0.3\n";
  const auto plastic = [&](const std::string& hardening) {
    std::string text = with("model = \"neo-hookean\"", "model = \"j2-hencky\"");
    return text.replace(text.find(ratio), ratio.size(), ratio + hardening);
  };
  const auto missing = plastic("");
  expect_scene_error(missing, {"[material]", "material.yield_stress", "nothing", "> 0"});
  expect_scene_error(with(ratio, ratio + "yield_stress = \"7 kPa\"\n"),
                     {"\"7 kPa\"", "material.yield_stress", "7 kPa", "j2-hencky"});
  expect_scene_error(
      plastic("yield_stress = \"1 MPa\"\nsaturation_stress = \"2 MPa\"\n"),
      {"\"2 MPa\"", "material.saturation_stress", "2 MPa", "saturation_exponent"});
  expect_scene_error(plastic("yield_stress = \"1 MPa\"\nhardening_modulus = \"-1 MPa\"\n"),
                     {"\"-1 MPa\"", "material.hardening_modulus", "-1 MPa", ">= 0"});
}

TEST(SceneFile, Fracture) {
  const std::string head = "[fracture]\n", G = "energy_release_rate = \"100 J/m^2\"\n";
  const auto crack = [&](const std::string& from, const std::string& to) {
    return plane_scene(head + G + "[[fracture.crack]]\nfrom = " + from + "\nto = " + to + "\n");
  };
  const std::string point = "[\"0\", \"0.5\"]";
  expect_scene_error(plane_scene(head),
                     {"[fracture]", "fracture.energy_release_rate", "nothing", "> 0"});
  expect_scene_error(
      plane_scene(head + "energy_release_rate = \"100 J/m^3\"\n"),
      {"\"100 J/m^3\"", "fracture.energy_release_rate", "stress", "unit of energy per area"});
  expect_scene_error(plane_scene(head + "energy_release_rate = \"0 J/m^2\"\n"),
                     {"\"0 J/m^2\"", "fracture.energy_release_rate", "0 J/m^2", "> 0"});
  expect_scene_error(plane_scene(head + G + "criterion = \"strian\"\n"),
                     {"\"strian\"", "fracture.criterion", "strian", "did you mean strain?"});
  expect_scene_error(plane_scene(head + G + "length = \"-1 mm\"\n"),
                     {"\"-1 mm\"", "fracture.length", "-1 mm", "> 0"});
  expect_scene_error(plane_scene(head + G + "crack = 7\n"),
                     {"7\n", "fracture.crack", "7", "[[crack]]"});
  expect_scene_error(crack(point, point), {"", "fracture.crack.0.to", "", "another point"});
  expect_scene_error(crack(point, "[\"X\", \"1\"]"),
                     {"[\"X\", \"1\"]", "fracture.crack.0.to", "", "parameters alone"});
  expect_scene_error(crack(point, "[\"t\", \"1\"]"),
                     {"[\"t\", \"1\"]", "fracture.crack.0.to", "", "parameters alone"});
  expect_scene_error(crack(point, "[\"0\"]"),
                     {"[\"0\"]", "fracture.crack.0.to", "an array of 1", "an array of 2"});
}

TEST(SceneFile, FractureBesideOtherStatements) {
  const std::string fracture = "[fracture]\nenergy_release_rate = \"100 J/m^2\"\n";
  expect_scene_error(with("end_time = \"1 ms\"", "static = true", fracture),
                     {"[fracture]", "fracture", "static = true", "end_time"});
  expect_scene_error(with("model = \"neo-hookean\"",
                          "model = \"j2-hencky\"\nyield_stress = \"1 kPa\"", fracture),
                     {"\"j2-hencky\"", "material.model", "j2-hencky", "an elastic model"});
}

TEST(SceneFile, Expressions) {
  const std::string head = "[initial]\nvelocity = ";
  expect_scene_error(plane_scene(head + "[\"0\", \"sin(W*X)\"]\n"),
                     {"\"sin(W*X)\"", "initial.velocity.1", "W", "expression of X, Y, Z, t"});
  expect_scene_error(plane_scene(head + "[\"0\"]\n"),
                     {"[\"0\"]", "initial.velocity", "an array of 1", "an array of 2"});
  expect_scene_error(plane_scene(head + "[\"0\", \"0\", \"1\"]\n"),
                     {"\"1\"", "initial.velocity.2", "1", "third direction"});
  expect_scene_error(plane_scene(head + "[\"free\", \"0\"]\n"),
                     {"\"free\"", "initial.velocity.0", "free", "expression"});
  expect_scene_error(plane_scene("[parameters]\na = {expr = \"b\"}\nb = {expr = \"a\"}\n"),
                     {"\"b\"", "parameters.a.expr", "b", "expression"});
  expect_scene_error(plane_scene("[parameters]\nmu = 3\n"),
                     {"mu", "parameters.mu", "meaning already", "another name"});
}

TEST(SceneFile, ExactNeedsAnExactSolution) {
  const std::string b = "[[boundary]]\ngroup = \"x0\"\nkind = \"displacement\"\nvalue = ";
  expect_scene_error(plane_scene(b + "\"exact\"\n"),
                     {"\"exact\"", "boundary.0.value", "exact", "[exact]"});
  expect_scene_error(plane_scene(b + "[\"exact\", \"free\"]\n"),
                     {"\"exact\"", "boundary.0.value.0", "exact", "[exact]"});
  expect_scene_error(plane_scene(b + "[\"free\", \"free\"]\n"),
                     {"[\"free\"", "boundary.0.value", "an array", "not \"free\""});
  expect_scene_error(plane_scene("[[quantity]]\nname = \"e\"\nkind = \"maximum\"\n"
                                 "field = \"displacement_error\"\n"),
                     {"\"displacement_error\"", "quantity.0.field", "", "[exact]"});
}

TEST(SceneFile, Contradictions) {
  expect_scene_error(plane_scene("", "static = true\n"),
                     {"\"1 ms\"", "end_time", "static = true", "either"});
  const std::string load =
      "[[boundary]]\ngroup = \"x0\"\nkind = \"traction\"\nvalue = [\"1\", \"0\"]\n";
  const std::string both = plane_scene(fixed_x0 + load);
  expect_scene_error(both,
                     {"\"x0\"\nkind = \"traction\"", "group", "direction 1", "one of the two"});
  expect_scene_error(plane_scene(load + load),
                     {"", "group", "second traction", "one traction"});
  // Components that do not meet are no contradiction.
  const std::string free = "[[boundary]]\ngroup = \"x0\"\nkind = \"displacement\"\n"
                           "value = [\"free\", \"0\"]\n";
  EXPECT_NO_THROW(ScratchScene(plane_scene(load + free)).read());
}

TEST(SceneFile, StaticsNeedsSupport) {
  const std::string text = with("end_time = \"1 ms\"", "static = true");
  expect_scene_error(text, {"true", "boundary", "no condition", "needs"});
  expect_scene_error(with("end_time = \"1 ms\"", "static = true",
                          fixed_x0 + "[initial]\nvelocity = [\"0\", \"0\"]\n"),
                     {"[initial]", "initial", "static", "without [initial]"});
}

TEST(SceneFile, Quantities) {
  const std::string head = "[[quantity]]\nname = \"tip\"\nkind = \"point\"\n";
  expect_scene_error(plane_scene(head), {"[[quantity]]", "quantity.0.at", "nothing", "length"});
  expect_scene_error(plane_scene(head + "at = [\"0 m\", 1]\n"),
                     {"1]", "quantity.0.at.1", "without a unit", "length"});
  const std::string good = head + "at = [\"0 m\", \"0 m\"]\n";
  expect_scene_error(plane_scene(good + good), {"", "quantity.1.name", "tip", "no other"});
}

TEST(SceneFile, MissingGeometry) {
  expect_scene_error(with("body.geo", "nobody.geo"),
                     {"\"nobody.geo\"", "geometry", "no file", ".geo"});
}

TEST(Overrides, ErrorsPointToTheCommandLine) {
  const ScratchScene scratch(plane_scene());
  const auto expect = [&](const scene::Override& override, const Expected& expected) {
    expect_input_error("", expected, [&] {
      try {
        (void)scratch.read({override});
      } catch (const InputError& error) {
        EXPECT_EQ(error.where().file, "command line") << error.what();
        throw;
      }
    });
  };
  expect({"material.densty", "1 kg/m^3"}, {"", "material.densty", "unknown", "density"});
  expect({"material.density", "-1 kg/m^3"}, {"", "material.density", "-1", "> 0"});
  expect({"material.density.x", "1"}, {"", "material.density.x", "material.density", "table"});
  expect({"boundary.3.kind", "fixed"}, {"", "boundary.3.kind", "3", "an index from 0 to 0"});
  expect({"boundary.0.kind", "fixed"}, {"", "boundary.0.group", "nothing", "physical group"});
  expect({"", "1"}, {"", "--set", "no key", "KEY=VALUE"});
}
