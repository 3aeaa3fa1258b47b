#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "shot/shot.h"

namespace ebru {
namespace {

/// Passes if `text` holds `part`, else shows both.
testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "expected to find\n  " << part << "\nin\n  " << text;
}

class ShotReader : public testing::Test {
 protected:
  ShotReader() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("ebru_" + std::to_string(getpid()) + "_" + test->name());
    std::filesystem::create_directories(folder_);
  }
  ~ShotReader() override { std::filesystem::remove_all(folder_); }

  Shot read(const std::string& text, const std::vector<std::string>& overrides = {}) {
    std::ofstream(folder_ / "dam.toml") << text;
    return readShot(folder_ / "dam.toml", overrides);
  }

  std::string problemsOf(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
      read(text, overrides);
    } catch (const UsageError& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
      return error.what();
    }
    return "no problem";
  }

  std::filesystem::path folder_;
};

const std::string good = R"([shot]
first_frame = 3
last_frame = 9
[fluid]
path = "caches/dam.####.vdb"
[texture]
method = "particles"
exemplar = "pebbles.png"
texel_size = 0.01
[camera]
position = [1, 2.5, 3]
size = [64, 36]
[[light]]
intensity = 2
[[light]]
type = "environment"
)";

TEST_F(ShotReader, ReadsEveryKindOfTable) {
  const Shot shot = read(good);
  EXPECT_EQ(shot.shot.name, "dam");
  EXPECT_EQ(shot.shot.first_frame, 3);
  EXPECT_EQ(shot.shot.last_frame, 9);
  EXPECT_EQ(shot.texture.method, "particles");
  EXPECT_DOUBLE_EQ(shot.texture.texel_size, 0.01);
  EXPECT_EQ(shot.scene.camera.position, (std::array<double, 3>{1.0, 2.5, 3.0}));
  EXPECT_EQ(shot.scene.camera.size, (std::array<int, 2>{64, 36}));
  ASSERT_EQ(shot.scene.lights.size(), 2u);
  EXPECT_DOUBLE_EQ(shot.scene.lights[0].intensity, 2.0);
  EXPECT_EQ(shot.scene.lights[1].type, "environment");
}

TEST_F(ShotReader, ResolvesPathsAgainstTheShotFile) {
  const Shot shot = read(good);
  EXPECT_EQ(shot.fluid.path, (folder_ / "caches/dam.####.vdb").string());
  EXPECT_EQ(shot.texture.exemplar, std::vector<std::string>{(folder_ / "pebbles.png").string()});
  EXPECT_EQ(read(good, {"texture.exemplar=/elsewhere/lava.png"}).texture.exemplar,
            std::vector<std::string>{"/elsewhere/lava.png"});
}

TEST_F(ShotReader, DisplacementWantsAHeightMap) {
  EXPECT_TRUE(says(problemsOf(std::string(good) + "[material]\ndisplacement = 0.02\n"),
                   "material.displacement: got 0.02, but no texture.height"));
  EXPECT_DOUBLE_EQ(read(good, {"material.displacement=0.02", "texture.height=pebbles_height.png"}).scene.material.displacement,
                   0.02);
}

TEST_F(ShotReader, ListsEveryProblemAtOnceWithItsLine) {
  const std::string problems = problemsOf(R"([shot]
first_fram = 1
[fluid]
path = 3
[texture]
texel_sise = 0.005
exemplar = "pebbles.png"
[camera]
size = [640, 360, 1]
vertical_fov_deg = 500
[render]
spp = 1.5
[groud]
enabled = true
)");
  EXPECT_TRUE(says(problems, "7 problems"));
  EXPECT_TRUE(says(problems, "dam.toml:2: unknown key shot.first_fram, did you mean first_frame"));
  EXPECT_TRUE(says(problems, "dam.toml:4: fluid.path: got 3 (integer), expected string"));
  EXPECT_TRUE(says(problems, "dam.toml:6: unknown key texture.texel_sise, did you mean texel_size"));
  EXPECT_TRUE(says(problems, "dam.toml:9: camera.size: got [640, 360, 1] (array), expected 2 integers"));
  EXPECT_TRUE(says(problems, "dam.toml:10: camera.vertical_fov_deg: got 500 deg, expected 0.01 to 170 deg"));
  EXPECT_TRUE(says(problems, "dam.toml:12: render.spp: got 1.5 (float), expected integer"));
  EXPECT_TRUE(says(problems, "dam.toml:13: unknown table [groud], did you mean ground"));
}

TEST_F(ShotReader, ChecksFramesTogether) {
  EXPECT_TRUE(says(problemsOf(good, {"shot.last_frame=2"}),
              "--set shot.last_frame=2: shot.last_frame: got 2, expected at least shot.first_frame = 3"));
}

TEST_F(ShotReader, AsksForWhatIsMissing) {
  EXPECT_TRUE(says(problemsOf("[texture]\nexemplar = \"a.png\"\n"), "fluid.path is missing"));
  const std::string fluid = "[fluid]\nsource = \"procedural\"\n";
  EXPECT_TRUE(says(problemsOf(fluid), "texture.exemplar is missing"));
  EXPECT_EQ(problemsOf(fluid + "[texture]\nmethod = \"plain\"\n"), "no problem");
}

TEST_F(ShotReader, GlowNeedsTheMapThatItIsMadeFrom) {
  const std::string glowing = "material.emission=blackbody";
  EXPECT_TRUE(says(problemsOf(good, {glowing}), "material.emission_source: got \"emission\""));
  EXPECT_TRUE(says(problemsOf(good, {glowing, "material.emission_source=height"}), "set texture.height"));
  EXPECT_EQ(problemsOf(good, {glowing, "material.emission_source=colour"}), "no problem");
  EXPECT_EQ(problemsOf(good, {glowing, "texture.emission=a.png"}), "no problem");
}

TEST_F(ShotReader, ErosionNeedsTheFeatureMapsThatItIsToUse) {
  const std::string erosion = std::string(good) + "[texture.erosion]\nfeature_map = \"image\"\n";
  const std::string method = "texture.method=erosion";
  EXPECT_TRUE(says(problemsOf(erosion, {method}),
                   "dam.toml:18: texture.erosion.feature_image: number of files: got 0, expected 1"));
  EXPECT_EQ(problemsOf(erosion, {method, "texture.erosion.feature_image=a.png"}), "no problem");
  const std::string two = "texture.erosion.feature_image=[\"a.png\", \"b.png\"]";
  EXPECT_TRUE(says(problemsOf(erosion, {method, two}), "--set " + two + ": texture.erosion.feature_image: number of files: got 2"));
  EXPECT_TRUE(says(problemsOf(good, {method, two}), "got 2, expected 1 like texture.exemplar"));
  EXPECT_EQ(problemsOf(good, {method, two, "texture.erosion.feature_map=distance"}), "no problem");
  EXPECT_EQ(problemsOf(erosion), "no problem") << "other methods do not ask";
}

TEST_F(ShotReader, FlagsAreNamedAsTheyWereGiven) {
  std::ofstream(folder_ / "dam.toml") << good;
  try {
    readShot(folder_ / "dam.toml", {"texture.method=plain"}, {{"texture.method=syntesis", "--method syntesis"}});
    FAIL() << "no error";
  } catch (const UsageError& error) {
    EXPECT_TRUE(says(error.what(), "--method syntesis: texture.method: got \"syntesis\""));
    EXPECT_TRUE(says(error.what(), "did you mean synthesis"));
    EXPECT_EQ(std::string(error.what()).find("--set"), std::string::npos) << error.what();
  }
  const Shot shot = readShot(folder_ / "dam.toml", {"texture.method=plain"}, {{"texture.method=quilt", "--method quilt"}});
  EXPECT_EQ(shot.texture.method, "quilt") << "flags win";
}

TEST_F(ShotReader, SaysWhereTheFileIsNotToml) {
  EXPECT_TRUE(says(problemsOf("[shot]\nname = = 3\n"), "dam.toml:2: not TOML"));
}

TEST_F(ShotReader, RefusesNumbersThatAreNotFinite) {
  EXPECT_TRUE(says(problemsOf(good, {"texture.texel_size=nan"}), "expected a finite number"));
  EXPECT_TRUE(says(problemsOf(good, {"texture.texel_size=inf"}), "expected a finite number"));
}

TEST_F(ShotReader, NamesTheChoices) {
  EXPECT_TRUE(says(problemsOf(good, {"camera.projection=ortographic"}),
              "expected one of perspective, orthographic, did you mean orthographic"));
}

TEST_F(ShotReader, NamesAMissingFile) {
  EXPECT_THROW(
      {
        try {
          readShot(folder_ / "nowhere.toml", {});
        } catch (const UsageError& error) {
          EXPECT_TRUE(says(error.what(), "nowhere.toml: no such shot file"));
          throw;
        }
      },
      UsageError);
}

TEST_F(ShotReader, OverridesWinOverTheFile) {
  const Shot shot = read(good, {"texture.texel_size=0.02", "shot.fps=30", "camera.size=[320, 180]"});
  EXPECT_DOUBLE_EQ(shot.texture.texel_size, 0.02);
  EXPECT_DOUBLE_EQ(shot.shot.fps, 30.0);
  EXPECT_EQ(shot.scene.camera.size, (std::array<int, 2>{320, 180}));
}

TEST_F(ShotReader, OverridesTakeBareStringsForStrings) {
  EXPECT_EQ(read(good, {"texture.method=synthesis"}).texture.method, "synthesis");
  EXPECT_EQ(read(good, {"texture.method=\"synthesis\""}).texture.method, "synthesis");
  EXPECT_EQ(read(good, {"shot.name=2024"}).shot.name, "2024");
  EXPECT_TRUE(says(problemsOf(good, {"shot.fps=fast"}), "got \"fast\" (string), expected float"));
}

TEST_F(ShotReader, OverridesReachIntoArraysAndMakeTheNextElement) {
  const Shot shot = read(good, {"light.0.intensity=5", "light.2.intensity=7", "obstacle.0.shape=sphere"});
  ASSERT_EQ(shot.scene.lights.size(), 3u);
  EXPECT_DOUBLE_EQ(shot.scene.lights[0].intensity, 5.0);
  EXPECT_DOUBLE_EQ(shot.scene.lights[2].intensity, 7.0);
  ASSERT_EQ(shot.scene.obstacles.size(), 1u);
  EXPECT_EQ(shot.scene.obstacles[0].shape, "sphere");
  EXPECT_TRUE(says(problemsOf(good, {"light.9.intensity=5"}), "got light number \"9\", expected 0 to 2"));
}

TEST_F(ShotReader, ListsWrongOverrides) {
  const std::string problems =
      problemsOf(good, {"texture.texel_sise=1", "textur.method=a", "spp", "camera.size.x=3"});
  EXPECT_TRUE(says(problems, "--set texture.texel_sise=1: unknown key texture.texel_sise, did you mean texel_size"));
  EXPECT_TRUE(says(problems, "--set textur.method=a: unknown table textur, did you mean texture"));
  EXPECT_TRUE(says(problems, "--set spp: got no \"=\", expected table.key=value"));
  EXPECT_TRUE(says(problems, "--set camera.size.x=3: got 3 names before the \"=\", expected camera.key"));
}

TEST_F(ShotReader, FluidOfACacheTakesItsTableAlone) {
  EXPECT_EQ(readFluid("dam.####.vdb", {"fluid.velocity=v"}).velocity, "v");
  EXPECT_EQ(readFluid("dam.####.vdb", {}).path, "dam.####.vdb");
  EXPECT_THROW(readFluid("dam.####.vdb", {"texture.method=a"}), UsageError);
}

TEST_F(ShotReader, FingerprintsFollowWhatDecides) {
  const Shot shot = read(good);
  const std::string state = stateFingerprint(shot), picture = pictureFingerprint(shot);
  EXPECT_EQ(state.size(), 16u);
  EXPECT_EQ(stateFingerprint(read(good)), state);

  const auto stateAfter = [&](const std::string& s) { return stateFingerprint(read(good, {s})); };
  const auto pictureAfter = [&](const std::string& s) { return pictureFingerprint(read(good, {s})); };
  for (const std::string setting : {"texture.texel_size=0.011", "shot.seed=2", "shot.fps=25", "shot.first_frame=4",
                                    "fluid.velocity_scale=2", "texture.method=synthesis"}) {
    EXPECT_NE(stateAfter(setting), state) << setting;
    EXPECT_NE(pictureAfter(setting), picture) << setting;
  }
  for (const std::string setting : {"render.spp=3", "camera.size=[10, 10]", "light.0.intensity=3"}) {
    EXPECT_EQ(stateAfter(setting), state) << setting;
    EXPECT_NE(pictureAfter(setting), picture) << setting;
  }
  for (const std::string setting : {"shot.last_frame=12", "shot.name=other"}) {
    EXPECT_EQ(stateAfter(setting), state) << setting;
    EXPECT_EQ(pictureAfter(setting), picture) << setting;
  }
}

// [texture.erosion] stands in [texture] and is a table of its own.
TEST_F(ShotReader, ReadsTablesInTables) {
  const Shot shot = read(good + "[texture.erosion]\nradius = 40\n", {"texture.erosion.fade=alpha"});
  EXPECT_EQ(shot.texture.erosion.radius, 40.0);
  EXPECT_EQ(shot.texture.erosion.fade, "alpha");
  EXPECT_EQ(read(good, {"texture.erosion.max_patches=7"}).texture.erosion.max_patches, 7);
  EXPECT_TRUE(says(problemsOf(good + "[texture.erosion]\nradios = 40\n"), "unknown key texture.erosion.radios"));
  EXPECT_TRUE(says(problemsOf(good + "[texture.erosion]\nradios = 40\n"), "radius"));
  EXPECT_TRUE(says(problemsOf(good, {"texture.erosion=3"}), "texture.erosion"));
  EXPECT_TRUE(says(problemsOf(good, {"texture.erozion.radius=3"}), "texture.erozion"));
  EXPECT_TRUE(says(problemsOf(good + "[texture.erosion]\nmax_distortion = 0.5\n"), "texture.erosion.max_distortion: got 0.5"));
  EXPECT_NE(stateFingerprint(read(good, {"texture.erosion.radius=40"})), stateFingerprint(read(good)));
}

TEST_F(ShotReader, StatesDependOnTheCameraOnlyWhereTheTextureKnowsIt) {
  const std::string moved = "camera.position=[4, 5, 6]", aware = "texture.quilt.camera_aware=true";
  const auto stateAfter = [&](const std::vector<std::string>& s) { return stateFingerprint(read(good, s)); };
  const std::string quilt = "texture.method=quilt";
  EXPECT_EQ(stateAfter({quilt}), stateAfter({quilt, moved}));
  EXPECT_NE(stateAfter({quilt}), stateAfter({quilt, aware}));
  EXPECT_NE(stateAfter({quilt, aware}), stateAfter({quilt, aware, moved}));
  EXPECT_NE(stateAfter({quilt, aware}), stateAfter({quilt, aware, "camera.size=[65, 36]"}));
  EXPECT_EQ(stateAfter({quilt, aware}), stateAfter({quilt, aware, "render.spp=3"}));
  // Other methods do not ask.
  EXPECT_EQ(stateAfter({aware}), stateAfter({aware, moved}));
}

const std::string keyed = R"([[camera.key]]
frame = 3
[[camera.key]]
frame = 7.5
position = [2, 2.5, 3]
focus_distance = 1.5
)";

// What a key does not say is as in [camera].
TEST_F(ShotReader, ReadsArraysInTables) {
  const Shot shot = read(good + keyed, {"camera.key.0.vertical_fov_deg=20", "camera.aperture_diameter=0.01",
                                        "camera.up=[0, 1, 1]", "camera.shutter=[-0.25, 0.25]"});
  const CameraOptions& camera = shot.scene.camera;
  ASSERT_EQ(camera.keys.size(), 2u);
  EXPECT_EQ(camera.keys[0].frame, 3.0);
  EXPECT_EQ(camera.keys[0].position, (std::array<double, 3>{1.0, 2.5, 3.0}));
  EXPECT_EQ(camera.keys[0].vertical_fov_deg, 20.0);
  EXPECT_EQ(camera.keys[1].frame, 7.5);
  EXPECT_EQ(camera.keys[1].position, (std::array<double, 3>{2.0, 2.5, 3.0}));
  EXPECT_EQ(camera.keys[1].up, (std::array<double, 3>{0.0, 1.0, 1.0}));
  EXPECT_EQ(camera.keys[1].vertical_fov_deg, 35.0);
  EXPECT_EQ(camera.keys[1].focus_distance, 1.5);
  EXPECT_EQ(camera.shutter, (std::array<double, 2>{-0.25, 0.25}));
}

TEST_F(ShotReader, ChecksTheKeysOfTheCamera) {
  EXPECT_TRUE(
      says(problemsOf(good + keyed, {"camera.key.1.frame=3"}), "camera.key.1.frame: got 3, expected more"));
  EXPECT_TRUE(
      says(problemsOf(good + "[[camera.key]]\nposition = [0, 0, 1]\n"), "camera.key.0.frame is missing"));
  EXPECT_TRUE(says(problemsOf(good + keyed + "roll = 3\n"), "unknown key camera.key.1.roll"));
  EXPECT_TRUE(says(problemsOf(good + "[camera.key]\nframe = 3\n"), "expected [[camera.key]]"));
  EXPECT_TRUE(says(problemsOf(good, {"camera.shutter=[0.5, 0]"}),
                   "--set camera.shutter=[0.5, 0]: camera.shutter: got"));
}

TEST_F(ShotReader, FingerprintsFollowTheCamerasMotionAndLens) {
  const std::string state = stateFingerprint(read(good + keyed)),
                    picture = pictureFingerprint(read(good + keyed));
  EXPECT_EQ(state, stateFingerprint(read(good)));
  EXPECT_NE(picture, pictureFingerprint(read(good)));
  const std::vector<std::string> quilt = {"texture.method=quilt", "texture.quilt.camera_aware=true"};
  const std::string aware = stateFingerprint(read(good + keyed, quilt));
  const auto with = [&](std::vector<std::string> settings, const std::string& one) {
    settings.push_back(one);
    return read(good + keyed, settings);
  };
  for (const std::string setting : {"camera.shutter=[-0.25, 0.25]", "camera.aperture_diameter=0.01",
                                    "camera.key.1.focus_distance=2", "camera.key.1.frame=8"}) {
    EXPECT_EQ(stateFingerprint(with({}, setting)), state) << setting;
    EXPECT_NE(pictureFingerprint(with({}, setting)), picture) << setting;
    // What is in view depends on where the camera is, not on its shutter and lens.
    EXPECT_EQ(stateFingerprint(with(quilt, setting)) == aware, setting != "camera.key.1.frame=8") << setting;
  }
}

TEST_F(ShotReader, FingerprintsSeeTheExemplarsContentAndNotItsFolder) {
  const auto write = [&](const std::string& content) { std::ofstream(folder_ / "pebbles.png") << content; };
  write("one");
  const std::string one = stateFingerprint(read(good));
  write("two");
  EXPECT_NE(stateFingerprint(read(good)), one);

  write("one");
  const std::filesystem::path elsewhere = folder_ / "elsewhere";
  std::filesystem::create_directories(elsewhere);
  std::filesystem::copy_file(folder_ / "pebbles.png", elsewhere / "pebbles.png");
  std::ofstream(elsewhere / "dam.toml") << good;
  EXPECT_EQ(stateFingerprint(readShot(elsewhere / "dam.toml", {})), one);
}

TEST_F(ShotReader, FingerprintsDoNotDependOnHowFilesAreNamed) {
  std::ofstream(folder_ / "pebbles.png") << "one";
  const std::string state = stateFingerprint(read(good)), picture = pictureFingerprint(read(good));
  const std::string absolute = folder_.string();
  const std::vector<std::string> otherNames = {
      "texture.exemplar=" + absolute + "/pebbles.png", "texture.exemplar=./pebbles.png",
      "fluid.path=" + absolute + "/caches/dam.####.vdb", "fluid.path=caches/../caches/dam.####.vdb"};
  for (const std::string& setting : otherNames) {
    EXPECT_EQ(stateFingerprint(read(good, {setting})), state) << setting;
    EXPECT_EQ(pictureFingerprint(read(good, {setting})), picture) << setting;
  }
  EXPECT_NE(stateFingerprint(read(good, {"fluid.path=caches/lava.####.vdb"})), state);

  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  const std::string relative = stateFingerprint(readShot("dam.toml", {})), absoluteShot =
      stateFingerprint(readShot(folder_ / "dam.toml", {}));
  std::filesystem::current_path(here);
  EXPECT_EQ(relative, absoluteShot);
}

}  // namespace
}  // namespace ebru
