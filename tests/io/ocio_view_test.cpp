#include "io/ocio_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/error.h"
#include "expect_contains.h"
#include "folder.h"
#include "io/preview_writer.h"

namespace ebru {
namespace {

/// Three views of which the answer is known: light as it is, its square root, and half of it.
constexpr const char* config = R"(ocio_profile_version: 2
roles:
  default: raw
  scene_linear: wide
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  Monitor:
    - !<View> {name: Plain, colorspace: raw}
    - !<View> {name: Root, colorspace: root}
  Projector:
    - !<View> {name: Half, colorspace: half}
active_displays: [Monitor, Projector]
active_views: [Plain, Root, Half]
colorspaces:
  - !<ColorSpace>
    name: raw
  - !<ColorSpace>
    name: root
    from_scene_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
  - !<ColorSpace>
    name: half
    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: wide
    to_scene_reference: !<MatrixTransform> {matrix: [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
)";

class OcioView : public testing::Test {
 protected:
  OcioView() { std::ofstream(file_) << config; }
  ~OcioView() override { unsetenv("OCIO"); }

  OutputOptions options(const std::string& display = "", const std::string& view = "",
                        const std::string& space = "raw") const {
    OutputOptions options;
    options.ocio_config = file_.string();
    options.ocio_display = display;
    options.ocio_view = view;
    options.ocio_colour_space = space;
    return options;
  }
  static std::array<float, 6> shown(const OutputOptions& options) {
    std::array<float, 6> rgb{0.25f, 0.5f, 0.04f, 4.0f, 0.0f, 1.0f};
    makeViewTransform(options)->apply(rgb.data(), 2);
    return rgb;
  }
  template <class Failure>
  static std::string problem(const OutputOptions& options) {
    try {
      makeViewTransform(options);
    } catch (const Failure& error) {
      return error.what();
    }
    return "nothing thrown";
  }

  test::Folder folder_;
  std::filesystem::path file_ = folder_ / "config.ocio";
};

void expectNear(const std::array<float, 6>& got, const std::array<float, 6>& expected) {
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], expected[i], 1e-4f) << i;
}

TEST_F(OcioView, DefaultsToTheFirstDisplayAndView) {
  expectNear(shown(options()), {0.25f, 0.5f, 0.04f, 4.0f, 0.0f, 1.0f});
}

TEST_F(OcioView, AppliesTheViewAskedForWhateverItsCase) {
  expectNear(shown(options("", "Root")), {0.5f, std::sqrt(0.5f), 0.2f, 2.0f, 0.0f, 1.0f});
  expectNear(shown(options("projector", "")), {0.125f, 0.25f, 0.02f, 2.0f, 0.0f, 0.5f});
}

TEST_F(OcioView, ColourSpaceIsTheRoleWhereNoUsualNameIsThere) {
  // Space `wide` swaps red and green.
  expectNear(shown(options("", "", "")), {0.5f, 0.25f, 0.04f, 0.0f, 4.0f, 1.0f});
  std::ofstream(file_, std::ios::app) << "  - !<ColorSpace>\n    name: lin_rec709\n";
  expectNear(shown(options("", "", "")), {0.25f, 0.5f, 0.04f, 4.0f, 0.0f, 1.0f});
}

TEST_F(OcioView, PreviewsGoThroughItAfterTheExposure) {
  ChannelImage image;
  image.width = image.height = 1;
  for (const char* name : {"R", "G", "B"}) image.add(name, ChannelType::half).data[0] = 0.0625f;
  OutputOptions raised = options("", "Root");
  raised.exposure = 2.0;
  EXPECT_EQ(PreviewWriter(raised).develop(image).data[0], 128);  // sqrt(4 * 0.0625) = 0.5
}

TEST_F(OcioView, TheEnvironmentNamesAConfigurationAndFilmicWinsOverIt) {
  OutputOptions automatic;
  EXPECT_EQ(ocioConfigInUse(automatic), "");
  setenv("OCIO", file_.c_str(), 1);
  EXPECT_EQ(ocioConfigInUse(automatic), file_);
  automatic.ocio_colour_space = "raw";
  expectNear(shown(automatic), {0.25f, 0.5f, 0.04f, 4.0f, 0.0f, 1.0f});
  OutputOptions filmic;
  filmic.view = "filmic";
  EXPECT_EQ(ocioConfigInUse(filmic), "");
  EXPECT_EQ(ocioConfigInUse(options()), file_);
}

TEST_F(OcioView, WrongNamesSayWhatThereIs) {
  const std::string display = problem<UsageError>(options("TV"));
  for (const char* part : {"output.ocio_display", "\"TV\"", "Monitor, Projector"})
    EXPECT_CONTAINS(display, part);
  const std::string view = problem<UsageError>(options("Monitor", "Half"));
  for (const char* part : {"output.ocio_view", "\"Half\"", "\"Monitor\"", "Plain, Root"})
    EXPECT_CONTAINS(view, part);
  const std::string space = problem<UsageError>(options("", "", "ACEScg"));
  for (const char* part : {"output.ocio_colour_space", "\"ACEScg\"", "raw", "wide"})
    EXPECT_CONTAINS(space, part);
}

TEST_F(OcioView, UnusableConfigurationsAreInputErrorsThatNameThem) {
  OutputOptions missing = options();
  missing.ocio_config = (folder_ / "none.ocio").string();
  EXPECT_CONTAINS(problem<InputError>(missing), "none.ocio: cannot be used for previews: got no such file");
  for (const char* text : {"These are words.\n", "ocio_profile_version: 2\n", ""}) {
    std::ofstream(file_) << text;
    EXPECT_CONTAINS(problem<InputError>(options("", "", "")), "config.ocio: cannot be used for previews")
        << text;
  }
  OutputOptions nothing;
  nothing.view = "ocio";
  EXPECT_CONTAINS(problem<UsageError>(nothing), "output.ocio_config");
}

}  // namespace
}  // namespace ebru
