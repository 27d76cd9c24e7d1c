#include "io/gnuplot.hpp"

#include <cmath>
#include <cstdlib>

#include "core/error.hpp"
#include "io/files.hpp"
#include "scratch.hpp"

namespace bagnold::io {
namespace {

const std::vector<PlotData> data{{"points", {{0, 1, 2}, {0, std::nan(""), 4}}}};

TEST(Gnuplot, DrawsInTheFormatOfTheName) {
  ASSERT_TRUE(have_gnuplot()) << "scripts/install-deps.sh installs it";
  const Scratch dir;
  for (const auto& [name, begin] : {std::pair{"it's.svg", "<?xml"}, {"a.png", "\x89PNG"}, {"a.pdf", "%PDF"}}) {
    plot(dir / name, "plot $points using 1:2 with linespoints title 'u'", data);
    EXPECT_TRUE(read_file(dir / name).starts_with(begin)) << name;
    EXPECT_FALSE(std::filesystem::exists(dir / (std::string(name) + ".gp")));
  }
}

TEST(Gnuplot, ItsErrorsAreReported) {
  ASSERT_TRUE(have_gnuplot()) << "scripts/install-deps.sh installs it";
  const Scratch dir;
  EXPECT_TRUE(contains(error_of<IoError>([&] { plot(dir / "a.svg", "plot $nothing", data); }), "gnuplot failed"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { plot(dir / "a.txt", "", data); }), ".svg, .png or .pdf"));
}

TEST(Gnuplot, SaysWhichPackageIsMissing) {
  const Scratch dir;
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", dir.path.c_str(), 1);
  EXPECT_FALSE(have_gnuplot());
  EXPECT_TRUE(contains(error_of<IoError>([&] { plot(dir / "a.svg", "plot x", data); }), "gnuplot-nox"));
  ::setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace bagnold::io
