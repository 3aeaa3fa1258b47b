#include <fmt/format.h>

#include <functional>

#include "core/error.h"
#include "texturing/erosion/erosion_method.h"
#include "texturing/particles/particles_method.h"
#include "texturing/plain_method.h"
#include "texturing/quilt/quilt_method.h"
#include "texturing/synthesis/synthesis_method.h"
#include "texturing/texture_method.h"

namespace ebru {
namespace {

using Maker = std::function<std::unique_ptr<TextureMethod>(const TextureOptions&, std::uint64_t, PhaseTimes*, const ViewFactory&)>;

/// Of a method that does not ask what is seen.
template <class Make>
Maker blind(Make* make) {
  return [make](const TextureOptions& options, std::uint64_t seed, PhaseTimes* times, const ViewFactory&) {
    return make(options, seed, times);
  };
}

struct Entry {
  TextureMethodInfo info;
  Maker make;
  int TextureOptions::*lookAhead = nullptr;  ///< null: sees nothing in advance
};

/// One line per method.
const std::vector<Entry>& registry() {
  static const std::vector<Entry> entries = {
      {{"particles", "texture coordinates ride on particles, 64 nearest interpolated (Rasmussen 2004): distorts"},
       blind(makeParticlesMethod)},
      {{"synthesis", "surface texture optimisation on advected texture particles (Kwatra 2007)"}, blind(makeSynthesisMethod)},
      {{"erosion", "deformable lapped patches, eroded along the exemplar's features where they are distorted (Gagnon 2021)"},
       blind(makeErosionMethod)},
      {{"quilt", "ours: texture follows the flow strictly, worn pieces are quilted anew along least-error cuts"}, makeQuiltMethod,
       &TextureOptions::look_ahead},
      {{"plain", "no texture: the fluid in its material's colour"}, blind(makePlainMethod)},
  };
  return entries;
}

}  // namespace

const std::vector<TextureMethodInfo>& textureMethods() {
  static const std::vector<TextureMethodInfo> infos = [] {
    std::vector<TextureMethodInfo> result;
    for (const Entry& entry : registry()) result.push_back(entry.info);
    return result;
  }();
  return infos;
}

int lookAheadOf(const TextureOptions& options) {
  for (const Entry& entry : registry())
    if (entry.info.name == options.method && entry.lookAhead) return options.*entry.lookAhead;
  return 0;
}

std::unique_ptr<TextureMethod> makeTextureMethod(const TextureOptions& options, std::uint64_t seed,
                                                 PhaseTimes* times, const ViewFactory& views) {
  std::string known;
  for (const Entry& entry : registry()) {
    if (entry.info.name == options.method) return entry.make(options, seed, times, views);
    known += (known.empty() ? "" : ", ") + entry.info.name;
  }
  throw UsageError(
      fmt::format("texture.method: unknown method: got \"{}\", expected one of {}", options.method, known));
}

}  // namespace ebru
