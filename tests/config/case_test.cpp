// The reader: what users see when they mistype, and the resolved case that runs again with the same bits.
#include "config/case.hpp"

#include <gtest/gtest.h>

namespace bagnold::config {
namespace {

struct Material {
  static constexpr std::string_view name = "material";
  double density = 2500;
  std::optional<double> step;
  std::int64_t count = 3;
  bool rough = true;
  Vec3 gravity{0, 0, -9.81};
  static constexpr auto fields() {
    return std::tuple{required("density", "kg/m^3", "grain density", &Material::density, positive()),
                      field("step", "s", "time step", &Material::step, positive()),
                      field("count", "", "how many", &Material::count, closed(1, 10)),
                      field("rough", "", "rough base", &Material::rough),
                      field("gravity", "m/s^2", "gravity vector", &Material::gravity)};
  }
};

struct Soft {
  static constexpr std::string_view name = "soft";
  double stiffness = 1;
  static constexpr auto fields() {
    return std::tuple{field("stiffness", "N/m", "spring", &Soft::stiffness, positive())};
  }
};
struct Hard {
  static constexpr std::string_view name = "hard";
  double modulus = 2;
  static constexpr auto fields() { return std::tuple{field("modulus", "Pa", "modulus", &Hard::modulus, positive())}; }
};
using Laws = Registry<Soft, Hard>;

std::string error_of(const std::string& text, auto&& read, const std::vector<std::string>& set = {}) {
  try {
    const Case input = Case::from_text(text, "c.toml", set);
    read(input);
    input.reject_unread();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}
const auto read_material = [](const Case& input) { (void)input.root().child("material").read<Material>(); };
const auto read_law = [](const Case& input) { (void)input.root().child("contact").read_law<Laws>("law", "soft"); };

TEST(Case, ReadsEveryTypeOfField) {
  const Case input = Case::from_text(
      "[material]\ndensity = 3\nstep = 1e-4\ncount = 7\nrough = false\ngravity = [1, 0, -2.5]\n", "c.toml");
  const auto m = input.root().child("material").read<Material>();
  EXPECT_EQ(m.density, 3.0);
  EXPECT_EQ(m.step, 1e-4);
  EXPECT_EQ(m.count, 7);
  EXPECT_FALSE(m.rough);
  EXPECT_EQ(m.gravity, (Vec3{1, 0, -2.5}));
  EXPECT_NO_THROW(input.reject_unread());
}

TEST(Case, ResolvedTextReadsBackTheSame) {
  const Case first = Case::from_text("[material]\ndensity = 0.1\n[contact]\nlaw = \"hard\"\n", "c.toml",
                                     {"material.step=3.3333333333333335e-05"});
  const auto a = first.root().child("material").read<Material>();
  (void)first.root().child("contact").read_law<Laws>("law", std::nullopt);
  const Case second = Case::from_text(first.resolved(), "resolved");
  const auto b = second.root().child("material").read<Material>();
  const auto law = second.root().child("contact").read_law<Laws>("law", std::nullopt);
  EXPECT_NO_THROW(second.reject_unread());
  EXPECT_EQ(first.resolved(), second.resolved());
  EXPECT_EQ(a.density, b.density);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(name_of(law), "hard");
}

TEST(Case, UnknownKeyNamesPlaceAndNearest) {
  EXPECT_EQ(error_of("[material]\ndensity = 1\n  denisty = 2\n", read_material),
            "c.toml:3:3: error: material.denisty: unknown key, is 'density' meant?");
}

TEST(Case, MissingRequiredKeyNamesUnit) {
  const std::string error = error_of("[material]\ncount = 2\n", read_material);
  EXPECT_NE(error.find("material.density: missing, expected a number [kg/m^3]"), std::string::npos) << error;
}

TEST(Case, RangeAndTypeErrors) {
  EXPECT_EQ(error_of("[material]\ndensity = -1\n", read_material),
            "c.toml:2:11: error: material.density = -1 is out of range, expected > 0 [kg/m^3]");
  EXPECT_EQ(error_of("[material]\ndensity = nan\n", read_material),
            "c.toml:2:11: error: material.density = nan is out of range, expected > 0 [kg/m^3]");
  EXPECT_EQ(error_of("[material]\ndensity = \"a\"\n", read_material),
            "c.toml:2:11: error: material.density: expected a number [kg/m^3], found a string");
  EXPECT_NE(error_of("[material]\ndensity = 1\ngravity = [1, 2]\n", read_material).find("three numbers"),
            std::string::npos);
  EXPECT_NE(error_of("[material]\ndensity = 1\ncount = 2.5\n", read_material).find("expected an integer"),
            std::string::npos);
  EXPECT_NE(error_of("material = 3\n", read_material).find("expected a table, found an integer"), std::string::npos);
}

TEST(Case, UnknownLawNamesNearest) {
  const std::string error = error_of("[contact]\nlaw = \"sfot\"\n", read_law);
  EXPECT_EQ(error,
            "c.toml:2:7: error: contact.law: unknown value 'sfot', expected one of soft, hard; is 'soft' meant?");
}

TEST(Case, ParametersOfAnotherLawAreUnknown) {
  EXPECT_NE(error_of("[contact]\nlaw = \"hard\"\nstiffness = 2\n", read_law).find("contact.stiffness: unknown key"),
            std::string::npos);
}

TEST(Case, SyntaxErrorHasLineAndColumn) { EXPECT_EQ(error_of("a = 1\nb = = 2\n", read_law).rfind("c.toml:2:", 0), 0u); }

TEST(Case, OverridesReplaceAddAndNameThemselves) {
  const Case input = Case::from_text("[material]\ndensity = 1\n", "c.toml", {"material.density=5", "contact.law=hard"});
  EXPECT_EQ(input.root().child("material").read<Material>().density, 5.0);
  EXPECT_EQ(name_of(input.root().child("contact").read_law<Laws>("law", "soft")), "hard");
  EXPECT_EQ(error_of("", read_law, {"contact.lwa=hard"}),
            "--set contact.lwa=hard: error: contact.lwa: unknown key, is 'law' meant?");
  EXPECT_NE(error_of("", read_law, {"contact"}).find("expected key.path=value"), std::string::npos);
}

}  // namespace
}  // namespace bagnold::config
