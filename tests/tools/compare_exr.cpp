/// Compares a picture with its reference through OpenImageIO: every channel, with a tolerance each, and the header.
///
///     compare_exr REFERENCE RESULT TOLERANCES
///
/// TOLERANCES is a text file; `#` starts a comment, other lines say
///     PATTERN  TOLERANCE  PERCENT
/// The first pattern (* stands for anything) that a channel's name matches decides: at most PERCENT of the pixels may
/// differ by more than TOLERANCE. Every channel has to match one. Header keys are equal, except for those that change
/// with each version. Ends with 0 if all agrees, 1 with a line per difference, 2 if a file cannot be read.

#include <OpenImageIO/imageio.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Picture {
  OIIO::ImageSpec spec;
  std::vector<float> data;
};

struct Tolerance {
  std::string pattern;
  double tolerance = 0.0, percent = 0.0;
};

int differences = 0;

template <class... Values>
void report(const char* format, Values... values) {
  std::printf("  ");
  std::printf(format, values...);
  std::printf("\n");
  ++differences;
}

bool readPicture(const std::string& path, Picture& picture) {
  auto input = OIIO::ImageInput::open(path);
  if (!input) {
    std::fprintf(stderr, "%s: cannot be read: %s\n", path.c_str(), OIIO::geterror().c_str());
    return false;
  }
  picture.spec = input->spec();
  if (input->seek_subimage(1, 0)) report("%s has more than one part", path.c_str());
  picture.data.resize(picture.spec.image_pixels() * static_cast<std::size_t>(picture.spec.nchannels));
  const bool read = input->read_image(0, 0, 0, picture.spec.nchannels, OIIO::TypeFloat, picture.data.data());
  if (!read) std::fprintf(stderr, "%s: cannot be read: %s\n", path.c_str(), input->geterror().c_str());
  return read;
}

bool readTolerances(const std::string& path, std::vector<Tolerance>& tolerances) {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    Tolerance t;
    if (words >> t.pattern >> t.tolerance >> t.percent) tolerances.push_back(t);
  }
  if (tolerances.empty()) std::fprintf(stderr, "%s: no tolerances\n", path.c_str());
  return !tolerances.empty();
}

/// Not equal to itself in the next version, or not chosen by the program.
bool isExempt(const std::string& key) {
  return key == "ebru:version" || key == "ebru:fingerprint" || key == "DateTime" || key == "Software";
}

std::map<std::string, std::string> headerOf(const OIIO::ImageSpec& spec) {
  std::map<std::string, std::string> header;
  for (const auto& attribute : spec.extra_attribs)
    header[attribute.name().string()] = OIIO::ImageSpec::metadata_val(attribute);
  return header;
}

void compareHeaders(const OIIO::ImageSpec& reference, const OIIO::ImageSpec& result) {
  const auto expected = headerOf(reference), got = headerOf(result);
  for (const auto& [key, value] : expected) {
    const auto found = got.find(key);
    if (found == got.end())
      report("header: %s is missing, expected %s", key.c_str(), value.c_str());
    else if (found->second != value && !isExempt(key))
      report("header: %s: got %s, expected %s", key.c_str(), found->second.c_str(), value.c_str());
  }
  for (const auto& [key, value] : got)
    if (!expected.count(key)) report("header: got %s = %s, expected no such key", key.c_str(), value.c_str());
}

void compareChannel(const Picture& reference, int referenceIndex, const Picture& result, int resultIndex,
                    const Tolerance& t) {
  const std::string& name = reference.spec.channelnames[static_cast<std::size_t>(referenceIndex)];
  if (reference.spec.channelformat(referenceIndex) != result.spec.channelformat(resultIndex))
    report("%s: got %s, expected %s", name.c_str(), result.spec.channelformat(resultIndex).c_str(),
           reference.spec.channelformat(referenceIndex).c_str());
  const auto channels = static_cast<std::size_t>(reference.spec.nchannels);
  const auto resultChannels = static_cast<std::size_t>(result.spec.nchannels);
  const std::size_t pixels = reference.spec.image_pixels();
  std::size_t beyond = 0, worst = 0;
  double worstDifference = -1.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double expected = reference.data[i * channels + static_cast<std::size_t>(referenceIndex)];
    const double got = result.data[i * resultChannels + static_cast<std::size_t>(resultIndex)];
    double difference = std::abs(got - expected);
    if (std::isnan(difference)) difference = HUGE_VAL;
    if (got == expected) difference = 0.0;
    if (difference > t.tolerance) ++beyond;
    if (difference > worstDifference) {
      worstDifference = difference;
      worst = i;
    }
  }
  const double percent = 100.0 * static_cast<double>(beyond) / static_cast<double>(pixels);
  if (percent <= t.percent) return;
  const auto width = static_cast<std::size_t>(reference.spec.width);
  report("%s: %.3f %% of the pixels differ by more than %g, expected at most %g %%; most at (%zu, %zu): got %g, "
         "expected %g",
         name.c_str(), percent, t.tolerance, t.percent, worst % width, worst / width,
         static_cast<double>(result.data[worst * resultChannels + static_cast<std::size_t>(resultIndex)]),
         static_cast<double>(reference.data[worst * channels + static_cast<std::size_t>(referenceIndex)]));
}

void compareChannels(const Picture& reference, const Picture& result, const std::vector<Tolerance>& tolerances) {
  const auto& expected = reference.spec.channelnames;
  const auto& got = result.spec.channelnames;
  for (const std::string& name : got)
    if (std::find(expected.begin(), expected.end(), name) == expected.end())
      report("got channel %s, expected no such channel", name.c_str());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto found = std::find(got.begin(), got.end(), expected[i]);
    const auto tolerance = std::find_if(tolerances.begin(), tolerances.end(), [&](const Tolerance& t) {
      return fnmatch(t.pattern.c_str(), expected[i].c_str(), 0) == 0;
    });
    if (found == got.end())
      report("channel %s is missing", expected[i].c_str());
    else if (tolerance == tolerances.end())
      report("channel %s has no tolerance", expected[i].c_str());
    else
      compareChannel(reference, static_cast<int>(i), result, static_cast<int>(found - got.begin()), *tolerance);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: compare_exr REFERENCE RESULT TOLERANCES\n");
    return 2;
  }
  Picture reference, result;
  std::vector<Tolerance> tolerances;
  if (!readPicture(argv[1], reference) || !readPicture(argv[2], result) || !readTolerances(argv[3], tolerances))
    return 2;
  if (reference.spec.width != result.spec.width || reference.spec.height != result.spec.height) {
    report("size: got %d x %d, expected %d x %d", result.spec.width, result.spec.height, reference.spec.width,
           reference.spec.height);
  } else {
    compareHeaders(reference.spec, result.spec);
    compareChannels(reference, result, tolerances);
  }
  return differences == 0 ? 0 : 1;
}
