#include "io/ply_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <vector>

#include "core/error.h"
#include "expect_contains.h"
#include "folder.h"

namespace ebru {
namespace {

namespace fs = std::filesystem;

class Ply : public testing::Test {
 protected:
  PlyFile read(const std::string& content, const PlyWanted& wanted = {}) const {
    std::ofstream(path, std::ios::binary) << content;
    return readPly(path, wanted);
  }
  /// Of the InputError that reading throws; empty when it does not.
  std::string complaint(const std::string& content) const {
    try {
      read(content);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  const test::Folder folder;
  const fs::path path = folder / "f.ply";
};

/// A value as a file of that byte order holds it.
template <class T>
std::string bytes(T value, bool bigEndian) {
  std::string raw(sizeof(T), '\0');
  std::memcpy(raw.data(), &value, sizeof(T));
  if (bigEndian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  return raw;
}

constexpr const char* allTypes =
    "element thing 2\nproperty char a\nproperty uint8 b\nproperty short c\nproperty uint16 d\nproperty int "
    "e\n"
    "property uint32 f\nproperty float g\nproperty double h\nproperty list ushort int16 l\nproperty float32 "
    "last\n"
    "end_header\n";

void expectAllTypes(const PlyFile& file) {
  ASSERT_EQ(file.elements.size(), 1u);
  const PlyElement& thing = file.elements[0];
  EXPECT_EQ(thing.count, 2u);
  EXPECT_EQ(thing.propertyNames(), "a b c d e f g h l last");
  const std::vector<double> expected{-100, 200, -30000, 60000, -2000000000, 4000000000, 0.5, 1e-300};
  for (std::size_t p = 0; p < expected.size(); ++p)
    EXPECT_EQ(thing.properties[p].values, std::vector<double>(2, expected[p])) << thing.properties[p].name;
  const PlyProperty& list = *thing.find("l");
  EXPECT_TRUE(list.isList);
  EXPECT_EQ(list.first, (std::vector<std::size_t>{0, 3, 3}));
  EXPECT_EQ(list.values, (std::vector<double>{7, -8, 9}));
  EXPECT_EQ(thing.find("last")->values, (std::vector<double>{2.5, 2.5}));
  EXPECT_EQ(thing.find("nothing"), nullptr);
}

TEST_F(Ply, EveryScalarTypeInBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string text =
        std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + allTypes;
    for (const int listed : {3, 0}) {
      text += bytes<std::int8_t>(-100, big) + bytes<std::uint8_t>(200, big) +
              bytes<std::int16_t>(-30000, big) + bytes<std::uint16_t>(60000, big) +
              bytes<std::int32_t>(-2000000000, big) + bytes<std::uint32_t>(4000000000u, big) +
              bytes(0.5f, big) + bytes(1e-300, big) + bytes(static_cast<std::uint16_t>(listed), big);
      for (int i = 0; i < listed; ++i) text += bytes(static_cast<std::int16_t>(i == 1 ? -8 : 7 + i), big);
      text += bytes(2.5f, big);
    }
    expectAllTypes(read(text));
  }
}

TEST_F(Ply, AsciiWithCommentsBlanksAndTheLinesOfWindows) {
  std::string text = std::string("ply\ncomment made by hand\nformat ascii 1.0\nobj_info 3\n") + allTypes +
                     "-100 200 -30000 60000 -2000000000 4000000000 +.5 1e-300 3 7 -8 9 2.5\n"
                     "-100\t200  -30000 60000 -2000000000 4000000000 5E-1 1e-300\n0 2.5";
  expectAllTypes(read(text));
  for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.replace(i, 1, "\r\n");
  expectAllTypes(read(text));
}

TEST_F(Ply, WhatIsNotWantedIsPassedOver) {
  const PlyFile file = read(
      "ply\nformat ascii 1.0\nelement noise 2\nproperty list uchar int n\nelement vertex 1\nproperty float "
      "x\n"
      "property float q\nend_header\n2 5 6\n1 7\n0.25 9\n",
      [](const std::string& element, const std::string& property) {
        return element == "vertex" && property == "x";
      });
  EXPECT_TRUE(file.find("noise")->properties[0].values.empty());
  EXPECT_TRUE(file.find("vertex")->find("q")->values.empty());
  EXPECT_EQ(file.find("vertex")->find("x")->values, std::vector<double>{0.25});
  EXPECT_EQ(file.description(), "noise (2: n), vertex (1: x q)");
}

TEST_F(Ply, ElementsOfNoRecordsOrNoProperties) {
  const PlyFile file = read(
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nelement mark 99999999999\nend_header\n");
  EXPECT_EQ(file.find("vertex")->count, 0u);
  EXPECT_TRUE(file.find("vertex")->find("x")->values.empty());
  EXPECT_EQ(file.find("mark")->count, 99999999999u);
}

TEST_F(Ply, MissingFileAndFolder) {
  EXPECT_THROW(readPly(folder / "nowhere.ply"), InputError);
  EXPECT_THROW(readPly(folder.path()), InputError);
}

TEST_F(Ply, WrongMagic) {
  EXPECT_CONTAINS(complaint("solid teapot\n"), "f.ply: magic: got no \"ply\"");
  EXPECT_CONTAINS(complaint(""), "magic");
}

TEST_F(Ply, HeaderThatEndsEarly) {
  EXPECT_CONTAINS(complaint("ply\nformat ascii 1.0\nelement vertex 3\n"), "end_header");
}

TEST_F(Ply, HeadersThatSayNonsense) {
  EXPECT_CONTAINS(complaint("ply\nformat ascii 2.0\nend_header\n"), "\"format ascii 2.0\"");
  EXPECT_CONTAINS(complaint("ply\nend_header\n"), "format");
  EXPECT_CONTAINS(complaint("ply\nformat ascii 1.0\nelement vertex -3\nend_header\n"), "element NAME COUNT");
  EXPECT_CONTAINS(complaint("ply\nformat ascii 1.0\nelement v 1\nproperty real x\nend_header\n"),
                  "type \"real\"");
  EXPECT_CONTAINS(complaint("ply\nformat ascii 1.0\nproperty float x\nend_header\n"), "property float x");
  EXPECT_CONTAINS(complaint("ply\nformat ascii 1.0\nelement v 1\nproperty list int x\nend_header\n"),
                  "property list int x");
}

TEST_F(Ply, TruncatedBinary) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty list uchar int "
      "l\nend_header\n";
  const std::string record = bytes(1.0f, false) + std::string(1, '\2') + bytes(5, false) + bytes(6, false);
  EXPECT_EQ(complaint(header + record + record), "");
  for (std::size_t cut = 1; cut <= 2 * record.size(); ++cut)
    EXPECT_CONTAINS(complaint((header + record + record).substr(0, header.size() + 2 * record.size() - cut)),
                    "f.ply: ");
}

TEST_F(Ply, TruncatedAscii) {
  EXPECT_CONTAINS(complaint("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float "
                            "y\nend_header\n1.5 2.5\n3.5 "),
                  "vertex 1 of 2, property \"y\": got the end of the file");
}

TEST_F(Ply, CountsBeyondTheFileAskForNoMemory) {
  EXPECT_CONTAINS(complaint("ply\nformat binary_big_endian 1.0\nelement vertex "
                            "18446744073709551615\nproperty double x\nend_header\nabc"),
                  "it is cut off");
  EXPECT_CONTAINS(
      complaint("ply\nformat ascii 1.0\nelement f 1\nproperty list int int l\nend_header\n2000000000 1 2\n"),
      "a list of 2000000000 values");
  EXPECT_CONTAINS(
      complaint("ply\nformat ascii 1.0\nelement f 1\nproperty list int int l\nend_header\n-1 2\n"),
      "list of -1");
}

TEST_F(Ply, TextThatIsNoNumber) {
  EXPECT_CONTAINS(complaint("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n12abc\n"),
                  "got \"12abc\"");
}

}  // namespace
}  // namespace ebru
