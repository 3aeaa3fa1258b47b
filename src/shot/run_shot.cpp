#include "shot/run_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "io/exr_file.h"
#include "render/renderer.h"
#include "shot/atlas_export.h"
#include "shot/fingerprint.h"
#include "shot/frame_pipeline.h"
#include "shot/interrupt.h"
#include "shot/ply_export.h"
#include "shot/previews.h"

namespace ebru {
namespace {

/// Lets something happen every few seconds.
class Occasionally {
 public:
  bool now() {
    const auto time = std::chrono::steady_clock::now();
    if (time - last_ < std::chrono::seconds(3)) return false;
    last_ = time;
    return true;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// The surface of every frame of the run, and its atlas if one is asked for: finished together.
class SurfaceExport {
 public:
  SurfaceExport(const Shot& shot, const RunOptions& options, FramePipeline& pipeline)
      : shot_(shot), width_(options.atlasWidth), height_(options.atlasHeight), pipeline_(pipeline) {}

  /// A file of this frame that is there, or the one that is made last.
  std::filesystem::path existing(int frame) const {
    std::error_code failed;
    const OutputFiles& files = pipeline_.files();
    return width_ > 0 && std::filesystem::exists(files.atlas(frame), failed) ? files.atlas(frame) : files.geometry(frame);
  }

  bool finished(int frame) const {
    const std::string print = fingerprint(frame);
    return isFinishedPly(pipeline_.files().geometry(frame), print) &&
           (width_ == 0 || isFinishedAtlas(pipeline_.files().atlas(frame), width_, height_, print));
  }

  /// @return what writes the files
  FramePipeline::Finish begin(int frame) const {
    const auto texture = pipeline_.texture(frame);
    return [this, frame, texture, fluid = pipeline_.fluid(frame), print = fingerprint(frame)] {
      std::optional<SurfaceAtlas> atlas;
      if (width_ > 0) atlas = writeAtlas(*fluid, *texture, print);
      pipeline_.log().stage(frame, "geometry");
      const PhaseTimer timer(&pipeline_.times(), "write geometry");
      writeTexturedPly(pipeline_.files().geometry(frame), *fluid, *texture, print, atlas ? &*atlas : nullptr,
                       pipeline_.files().atlas(frame).filename().string());
    };
  }

 private:
  /// A surface without an atlas has other faces than one with it, and other atlases have other coordinates.
  std::string fingerprint(int frame) const {
    const std::string picture = pipeline_.identity().picture(frame);
    if (width_ == 0) return picture;
    return Fingerprint().add(picture).add(fmt::format("atlas {}x{}", width_, height_)).text();
  }

  SurfaceAtlas writeAtlas(const FluidFrame& fluid, const TextureField& texture, const std::string& print) const {
    PhaseTimes& times = pipeline_.times();
    pipeline_.log().stage(fluid.frame, "atlas");
    std::optional<PhaseTimer> timer(std::in_place, &times, "atlas: charts");
    SurfaceAtlas atlas = makeSurfaceAtlas(fluid.mesh, width_, height_, fmt::format("frame {}", fluid.frame));
    timer.emplace(&times, "atlas: look-ups");
    ChannelImage image = bakeAtlas(fluid, atlas, texture);
    addShotAttributes(image, shot_, print);
    timer.emplace(&times, "write atlas");
    writeExr(pipeline_.files().atlas(fluid.frame), image);
    return atlas;
  }

  const Shot& shot_;
  const int width_, height_;
  FramePipeline& pipeline_;
};

}  // namespace

void renderShot(const Shot& shot, const RunOptions& options) {
  catchInterrupts();
  FramePipeline pipeline(shot, options, false);
  const OutputFiles& files = pipeline.files();
  const std::vector<int> frames = pipeline.framesToDo(
      [&](int f) { return files.picture(f); },
      [&](int f) { return isFinishedPicture(files.picture(f), pipeline.identity().picture(f)); });
  std::optional<Previews> previews;
  if (options.preview) previews.emplace(shot, files, pipeline.times());

  if (!frames.empty()) {
    const Renderer renderer(shot.scene, static_cast<std::uint64_t>(shot.shot.seed), &pipeline.times());
    pipeline.checkVelocity(frames);
    bool warned = false;
    const auto warnOnce = [&](const std::string& message) {
      if (!warned) pipeline.log().warn(message);
      warned = true;
    };
    // Texture and hierarchy of a frame are made while the one before is lit and written.
    pipeline.forEach(frames, [&](int frame) -> FramePipeline::Finish {
      const auto texture = pipeline.texture(frame);
      pipeline.log().stage(frame, "surface");
      const auto previous = pipeline.fluid(frame - 1), current = pipeline.fluid(frame),
                 next = pipeline.fluid(frame + 1);
      const auto prepared = renderer.prepare({previous.get(), current.get(), next.get(), texture.get(),
                                              static_cast<float>(shot.texture.texel_size), warnOnce});
      const std::string print = pipeline.identity().picture(frame);
      return [&, texture, previous, current, next, prepared, print, frame] {
        pipeline.log().stage(frame, "picture");
        RenderProgress watch;
        if (previews)
          watch = [&, occasionally = Occasionally()](const ChannelImage& unfinished) mutable {
            if (occasionally.now()) previews->writePartial(frame, unfinished);
          };
        ChannelImage image = renderer.render(*prepared, watch);
        addShotAttributes(image, shot, print);
        pipeline.log().stage(frame, "writing");
        {
          const PhaseTimer timer(&pipeline.times(), "write picture");
          writeExr(files.picture(frame), image, shot.output);
        }
        if (previews) previews->write(frame, image);
      };
    });
  }

  std::vector<std::string> places = {"pictures  " + files.picturePattern().string()};
  if (previews && !pipeline.frames().empty()) {
    const auto fingerprintOf = [&](int f) { return pipeline.identity().picture(f); };
    previews->complete(pipeline.frames(), fingerprintOf);
    places.push_back("previews  " + files.previewPattern().string());
    // Every chunk would write the same movie, with what the others have finished by then.
    const std::string movie =
        options.chunks == 1 ? previews->makeMovie(pipeline.frames(), fingerprintOf, pipeline.log()) : "";
    if (!movie.empty()) places.push_back("movie     " + movie);
  }
  pipeline.summarise(frames.size(), frames.size() == 1 ? "frame" : "frames", places);
}

void synthesiseShot(const Shot& shot, const RunOptions& options) {
  catchInterrupts();
  FramePipeline pipeline(shot, options, true);
  StateStore& states = pipeline.states();
  const std::vector<int> frames =
      pipeline.framesToDo([&](int f) { return states.pathOf(f); }, [&](int f) { return states.valid(f); });
  if (!frames.empty()) pipeline.checkVelocity(frames);
  pipeline.forEach(frames, [&](int frame) -> FramePipeline::Finish {
    pipeline.texture(frame);
    return {};
  });
  pipeline.summarise(frames.size(), frames.size() == 1 ? "state" : "states",
                     {"states  " + states.pathOf(shot.shot.first_frame).parent_path().string()});
}

void exportShot(const Shot& shot, const RunOptions& options) {
  catchInterrupts();
  FramePipeline pipeline(shot, options, false);
  const SurfaceExport surfaces(shot, options, pipeline);
  const OutputFiles& files = pipeline.files();
  const std::vector<int> frames = pipeline.framesToDo([&](int f) { return surfaces.existing(f); },
                                                      [&](int f) { return surfaces.finished(f); });
  pipeline.forEach(frames, [&](int frame) { return surfaces.begin(frame); });
  std::vector<std::string> places = {"surfaces  " + files.geometryPattern().string()};
  if (options.atlasWidth > 0) places.push_back("atlases   " + files.atlasPattern().string());
  pipeline.summarise(frames.size(), frames.size() == 1 ? "surface" : "surfaces", places);
}

}  // namespace ebru
