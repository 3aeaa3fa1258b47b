#include "shot/shot_tables.h"

namespace ebru {
namespace {

template <class Options>
ShotTable single(std::string name, std::string help, ShotTable::Decides decides, Options& (*options)(Shot&),
                 std::vector<std::string> undecided = {}) {
  ShotTable table;
  table.name = std::move(name);
  table.help = std::move(help);
  table.decides = decides;
  table.undecided = std::move(undecided);
  table.resize = [](Shot&, std::size_t) {};
  table.size = [](const Shot&) { return std::size_t{1}; };
  table.fields = [options](Shot& shot, std::size_t) { return fields(options(shot)); };
  return table;
}

template <class Options>
ShotTable array(std::string name, std::string help, std::vector<Options>& (*options)(Shot&)) {
  ShotTable table;
  table.name = std::move(name);
  table.help = std::move(help);
  table.isArray = true;
  table.resize = [options](Shot& shot, std::size_t count) { options(shot).resize(count); };
  table.size = [options](const Shot& shot) { return options(const_cast<Shot&>(shot)).size(); };
  table.fields = [options](Shot& shot, std::size_t index) { return fields(options(shot).at(index)); };
  return table;
}

/// A key says what [camera] says, which is read before, unless it says otherwise.
ShotTable cameraKeys() {
  ShotTable table = array<CameraKeyOptions>(
      "camera.key",
      "Where the camera is in one frame each; without keys it rests. Between keys it moves smoothly, before the first and "
      "after the last it rests. What a key does not say is as in [camera].",
      [](Shot& s) -> auto& { return s.scene.camera.keys; });
  table.decides = ShotTable::Decides::view;
  table.resize = [](Shot& s, std::size_t count) { s.scene.camera.keys.assign(count, keyOf(s.scene.camera)); };
  return table;
}

}  // namespace

OptionFields fields(ShotOptions& options) {
  return {
      {.key = "name", .target = &options.name, .unit = "",
       .help = "Names the files: NAME.####.exr. Without it the shot file's own name."},
      {.key = "first_frame", .target = &options.first_frame, .unit = "frame",
       .help = "Where the texture is laid. Every later frame depends on it."},
      {.key = "last_frame", .target = &options.last_frame, .unit = "frame", .help = "Inclusive."},
      {.key = "fps", .target = &options.fps, .unit = "1/s",
       .help = "Frames per second: frame f is at f / fps seconds.", .lower = 0.001, .upper = 100000.0},
      {.key = "seed", .target = &options.seed, .unit = "",
       .help = "Of every random number. The same shot and seed give the same bits.", .lower = 0},
  };
}

const std::vector<ShotTable>& shotTables() {
  using enum ShotTable::Decides;
  static const std::vector<ShotTable> tables = {
      single<ShotOptions>("shot", "What is rendered.", states, [](Shot& s) -> auto& { return s.shot; },
                          {"name", "last_frame"}),
      single<FluidOptions>("fluid", "Where the fluid comes from.", states,
                           [](Shot& s) -> auto& { return s.fluid; }),
      single<TextureOptions>("texture", "What it is covered with, and how.", states,
                             [](Shot& s) -> auto& { return s.texture; }),
      single<ErosionOptions>("texture.erosion", "What method erosion alone asks for.", states,
                             [](Shot& s) -> auto& { return s.texture.erosion; }),
      single<QuiltOptions>("texture.quilt", "What method quilt alone asks for.", states,
                           [](Shot& s) -> auto& { return s.texture.quilt; }),
      single<CameraOptions>("camera", "Where it is seen from.", view,
                            [](Shot& s) -> auto& { return s.scene.camera; }),
      cameraKeys(),
      single<RenderOptions>("render", "How the picture is taken.", pictures,
                            [](Shot& s) -> auto& { return s.scene.render; }),
      single<MaterialOptions>("material", "What the fluid is made of.", pictures,
                              [](Shot& s) -> auto& { return s.scene.material; }),
      array<LightOptions>("light", "One light each; without any a clear sky with its sun.",
                          [](Shot& s) -> auto& { return s.scene.lights; }),
      single<GroundOptions>("ground", "A plane below the fluid.", pictures,
                            [](Shot& s) -> auto& { return s.scene.ground; }),
      array<ObstacleOptions>("obstacle", "Solid things that stand in the fluid; they are drawn, not simulated.",
                             [](Shot& s) -> auto& { return s.scene.obstacles; }),
      single<OutputOptions>("output", "How pictures are stored, and how previews show them.", pictures,
                            [](Shot& s) -> auto& { return s.output; },
                            {"view", "exposure", "transparent", "ocio_config", "ocio_display", "ocio_view",
                             "ocio_colour_space"}),
  };
  return tables;
}

}  // namespace ebru
