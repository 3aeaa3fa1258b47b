#include <gtest/gtest.h>

#include <bit>
#include <fstream>

#include "core/random.h"
#include "folder.h"
#include "io/exr_file.h"
#include "render/film/aovs.h"
#include "shot/fingerprint.h"
#include "shot/output_files.h"
#include "shot/previews.h"

namespace ebru {
namespace {

TEST(Output, LossyCompressionKeepsEveryBitOfTheDataOfAPicture) {
  const test::Folder folder;
  FrameBuffer frame(70, 41);
  ChannelImage picture = frame.take();
  for (std::size_t c = 0; c < picture.channels.size(); ++c) {
    Random random(1, 0, c);
    for (float& value : picture.channels[c].data) value = 20.0f * random.uniform() - 10.0f;
  }
  writeExr(folder / "a.exr", picture, {.compression = "dwaa", .dwa_level = 200.0});
  const ChannelImage read = readExr(folder / "a.exr");
  ASSERT_EQ(read.channels.size(), aovCount);
  for (const AovInfo& aov : aovTable()) {
    const std::string name(aov.channel);
    if (aov.type == ChannelType::half) {
      EXPECT_TRUE(aov.unit == "scene-linear" || name == "A")
          << name << " is data: 32-bit float keeps it exact under dwaa";
      continue;
    }
    const auto &got = read.find(name)->data, &expected = picture.find(name)->data;
    for (std::size_t i = 0; i < got.size(); ++i)
      ASSERT_EQ(std::bit_cast<std::uint32_t>(got[i]), std::bit_cast<std::uint32_t>(expected[i]))
          << name << " " << i;
  }
}

TEST(Output, FingerprintsKnowWhatIsStoredAndWhatIsOnlyShown) {
  const Shot plain;
  Shot shot;
  const std::string pictures = pictureFingerprint(plain), states = stateFingerprint(plain),
                    previews = previewFingerprint(plain);
  for (const OptionField& field : fields(shot.output)) {
    shot.output = {};
    if (auto* text = std::get_if<std::string*>(&field.target))
      **text = field.choices.empty() ? "other" : field.choices[1];
    if (auto* flag = std::get_if<bool*>(&field.target)) **flag = !**flag;
    if (auto* number = std::get_if<double*>(&field.target)) **number += 1.0;
    const bool stored = field.key == "compression" || field.key == "dwa_level";
    EXPECT_EQ(pictureFingerprint(shot) != pictures, stored) << field.key;
    EXPECT_EQ(stateFingerprint(shot), states) << field.key;
    // A configuration counts by what it holds; this one is not there.
    EXPECT_NE(previewFingerprint(shot), previews) << field.key;
  }
}

TEST(Output, FingerprintOfPreviewsFollowsTheConfiguration) {
  const test::Folder folder;
  Shot shot;
  shot.output.ocio_config = (folder / "a.ocio").string();
  std::ofstream(folder / "a.ocio") << "one";
  const std::string one = previewFingerprint(shot);
  std::ofstream(folder / "a.ocio") << "two";
  EXPECT_NE(previewFingerprint(shot), one);
}

class PreviewFiles : public testing::Test {
 protected:
  PreviewFiles() {
    shot_.shot.name = "tiny";
    for (const int frame : {1, 2}) {
      ChannelImage picture;
      picture.width = picture.height = 2;
      for (const char* name : {"R", "G", "B", "A"})
        picture.add(name, ChannelType::half).data.assign(4, 0.1f * float(frame));
      addShotAttributes(picture, shot_, fingerprintOf(frame));
      writeExr(files_.picture(frame), picture);
    }
  }
  static std::string fingerprintOf(int frame) { return "print" + std::to_string(frame); }
  auto stamp(int frame) const { return std::filesystem::last_write_time(files_.preview(frame)); }

  test::Folder folder_;
  Shot shot_;
  OutputFiles files_{folder_.path(), "tiny"};
  PhaseTimes times_;
};

TEST_F(PreviewFiles, CompleteMakesWhatIsMissingPartialOrOfAnotherPictureOrView) {
  const auto old = std::filesystem::file_time_type(std::chrono::seconds(1));
  const auto complete = [&](const auto& print) {
    for (const int frame : {1, 2})
      if (std::filesystem::exists(files_.preview(frame)))
        std::filesystem::last_write_time(files_.preview(frame), old);
    Previews(shot_, files_, times_).complete({1, 2}, print);
    return std::pair(stamp(1) != old, stamp(2) != old);
  };
  using Made = std::pair<bool, bool>;
  EXPECT_EQ(complete(fingerprintOf), Made(true, true)) << "missing";
  EXPECT_EQ(complete(fingerprintOf), Made(false, false)) << "there already";
  std::filesystem::remove(files_.preview(2));
  EXPECT_EQ(complete(fingerprintOf), Made(false, true)) << "one missing";
  Previews(shot_, files_, times_).writePartial(1, readExr(files_.picture(1)));
  EXPECT_EQ(complete(fingerprintOf), Made(true, false)) << "one partial";
  ChannelImage other = readExr(files_.picture(2));
  addShotAttributes(other, shot_, "other");
  Previews(shot_, files_, times_).write(2, other);
  EXPECT_EQ(complete(fingerprintOf), Made(false, true)) << "one of another picture";
  shot_.output.exposure = 1.0;
  EXPECT_EQ(complete(fingerprintOf), Made(true, true)) << "another view";
}

}  // namespace
}  // namespace ebru
