#include "io/state_file.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>

#include "core/error.h"
#include "folder.h"
#include "io/atomic_file.h"

namespace ebru {
namespace {

namespace fs = std::filesystem;

class StateFile : public testing::Test {
 protected:
  void writeSample() const {
    StateWriter writer;
    writer.array("ids", std::vector<std::uint32_t>{3, 1, 2});
    writer.array("empty", std::vector<float>{});
    writer.value("next", 42);
    writer.write(path, "abc");
  }
  std::string bytes() const {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void replaceBytes(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }

  const test::Folder folder;
  const fs::path path = folder / "states" / "shot.0001.state";  // in a folder that has to be made
};

TEST_F(StateFile, ReturnsWhatWasWritten) {
  writeSample();
  const StateReader reader(path, "abc");
  EXPECT_EQ(reader.array<std::uint32_t>("ids"), (std::vector<std::uint32_t>{3, 1, 2}));
  EXPECT_TRUE(reader.array<float>("empty").empty());
  EXPECT_EQ(reader.value<int>("next"), 42);
}

TEST_F(StateFile, SameContentGivesSameBytes) {
  writeSample();
  const std::string first = bytes();
  writeSample();
  EXPECT_EQ(first, bytes());
}

TEST_F(StateFile, RefusesAnotherFingerprint) {
  writeSample();
  EXPECT_THROW(StateReader(path, "xyz"), InputError);
}

TEST_F(StateFile, ItsBeginningTellsWhoseItIs) {
  EXPECT_FALSE(beginsAsState(path, "abc")) << "missing";
  writeSample();
  EXPECT_TRUE(beginsAsState(path, "abc"));
  EXPECT_FALSE(beginsAsState(path, "ab"));
  EXPECT_FALSE(beginsAsState(path, "xyz"));
  replaceBytes(bytes().substr(0, 10));
  EXPECT_FALSE(beginsAsState(path, "abc")) << "cut off";
}

TEST_F(StateFile, RefusesEveryTruncation) {
  writeSample();
  const std::string whole = bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    replaceBytes(whole.substr(0, size));
    EXPECT_THROW(StateReader(path, "abc"), InputError) << "at " << size << " bytes";
  }
}

TEST_F(StateFile, RefusesDamageToAnyByte) {
  writeSample();
  const std::string whole = bytes();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    replaceBytes(damaged);
    try {
      const StateReader reader(path, "abc");
      // A flipped bit that zstd's format ignores may pass, with the content intact.
      EXPECT_EQ(reader.array<std::uint32_t>("ids"), (std::vector<std::uint32_t>{3, 1, 2})) << "byte " << i;
    } catch (const InputError&) {
    }
  }
}

TEST_F(StateFile, NamesTheMissingArrayAndChecksItsType) {
  writeSample();
  const StateReader reader(path, "abc");
  EXPECT_THROW(reader.array<float>("velocities"), InputError);
  EXPECT_THROW(reader.array<double>("ids"), InputError);
}

TEST_F(StateFile, AFailedWriteLeavesTheOldFileAndNoTemporary) {
  writeSample();
  const std::string before = bytes();
  EXPECT_THROW(writeAtomically(path, [](const fs::path& temporary) {
                 std::ofstream(temporary) << "half";
                 throw std::runtime_error("disk on fire");
               }),
               OutputError);
  EXPECT_EQ(before, bytes());
  EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), {}), 1);
}

TEST_F(StateFile, UnwritableFolderIsAnOutputError) {
  EXPECT_THROW(writeTextAtomically("/proc/ebru/none.txt", "x"), OutputError);
}

TEST_F(StateFile, StaleTemporariesOfDeadProcessesAreRemoved) {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const fs::path stale = folder / ("a.tmp." + std::string(host) + ".2147483000.0.exr");
  std::ofstream(stale) << "x";
  const fs::path own = folder / ("b.tmp." + std::string(host) + "." + std::to_string(getpid()) + ".0.exr");
  std::ofstream(own) << "x";
  removeStaleTemporaries(folder.path());
  EXPECT_FALSE(fs::exists(stale));
  EXPECT_TRUE(fs::exists(own));
}

}  // namespace
}  // namespace ebru
