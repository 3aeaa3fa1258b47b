#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include "core/error.h"
#include "render/camera/camera_path.h"
#include "shot/config_value.h"
#include "shot/option_binding.h"
#include "shot/shot.h"
#include "shot/shot_tables.h"
#include "shot/spelling.h"

namespace ebru {
namespace {

using Kind = ConfigValue::Kind;

std::vector<std::string> tableNames() {
  std::vector<std::string> names;
  for (const ShotTable& table : shotTables()) names.push_back(table.name);
  return names;
}

const ShotTable* findTable(const std::string& name) {
  for (const ShotTable& table : shotTables())
    if (table.name == name) return &table;
  return nullptr;
}

std::vector<std::string> splitAtDots(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

ConfigValue emptyTable(const std::string& key, const std::string& where) {
  ConfigValue table;
  table.kind = Kind::table;
  table.key = key;
  table.where = where;
  return table;
}

/// Puts tables in tables beside their parents, under the name that the list of tables has for them.
void liftInnerTables(ConfigValue& config) {
  for (const ShotTable& table : shotTables()) {
    const std::size_t dot = table.name.find('.');
    ConfigValue* parent = dot == std::string::npos ? nullptr : config.find(table.name.substr(0, dot));
    ConfigValue* inner = parent && parent->kind == Kind::table ? parent->find(table.name.substr(dot + 1)) : nullptr;
    if (!inner) continue;
    ConfigValue lifted = std::move(*inner);
    parent->items.erase(parent->items.begin() + (inner - parent->items.data()));
    lifted.key = table.name;
    config.items.push_back(std::move(lifted));
  }
}

/// "texture.erosion.fade" as the table "texture.erosion" and its key, where there is such a table.
std::vector<std::string> tableAndKey(const std::string& setting) {
  std::vector<std::string> path = splitAtDots(setting);
  if (path.size() > 2 && findTable(path[0] + "." + path[1])) {
    path[1] = path[0] + "." + path[1];
    path.erase(path.begin());
  }
  return path;
}

/// The table that "light.0" or "texture" names, made if the file does not have it.
/// @return null with a problem noted
ConfigValue* overriddenTable(ConfigValue& config, const std::vector<std::string>& path, const std::string& where,
                             std::vector<std::string>& problems) {
  const ShotTable* table = findTable(path[0]);
  if (!table) {
    problems.push_back(fmt::format("{}: unknown table {}{}", where, path[0], didYouMean(path[0], tableNames())));
    return nullptr;
  }
  const std::size_t depth = table->isArray ? 3 : 2;
  if (path.size() != depth) {
    problems.push_back(fmt::format("{}: got {} names before the \"=\", expected {}", where, path.size(),
                                   table->isArray ? path[0] + ".NUMBER.key" : path[0] + ".key"));
    return nullptr;
  }
  ConfigValue* value = config.find(path[0]);
  if (!value) {
    ConfigValue made = emptyTable(path[0], where);
    if (table->isArray) made.kind = Kind::array;
    config.items.push_back(made);
    value = &config.items.back();
  }
  if (!table->isArray) return value->kind == Kind::table ? value : nullptr;
  if (value->kind != Kind::array) return nullptr;
  std::size_t index = 0;
  const char* end = path[1].data() + path[1].size();
  const auto parsed = std::from_chars(path[1].data(), end, index);
  if (parsed.ec != std::errc() || parsed.ptr != end || index > value->items.size()) {
    problems.push_back(fmt::format("{}: got {} number \"{}\", expected 0 to {} ({} makes a new one)", where, path[0],
                                   path[1], value->items.size(), value->items.size()));
    return nullptr;
  }
  if (index == value->items.size()) value->items.push_back(emptyTable("", where));
  return &value->items[index];
}

/// @param where  for messages
void applySetting(ConfigValue& config, const std::string& setting, const std::string& where,
                  std::vector<std::string>& problems) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    problems.push_back(where + ": got no \"=\", expected table.key=value");
    return;
  }
  const std::vector<std::string> path = tableAndKey(setting.substr(0, equals));
  ConfigValue* table = overriddenTable(config, path, where, problems);
  if (!table || table->kind != Kind::table) return;
  ConfigValue value = parseOverrideValue(setting.substr(equals + 1));
  value.where = where;
  value.key = path.back();
  if (ConfigValue* present = table->find(value.key))
    *present = std::move(value);
  else
    table->items.push_back(std::move(value));
}

void applyOverride(ConfigValue& config, const std::string& setting, std::vector<std::string>& problems) {
  applySetting(config, setting, "--set " + setting, problems);
}

/// Binds a table or every element of an array of tables.
void bindOneOrMany(const ShotTable& table, const ConfigValue* value, const std::filesystem::path& folder, Shot& shot,
          std::vector<std::string>& problems) {
  const Kind expected = table.isArray ? Kind::array : Kind::table;
  if (value && value->kind != expected) {
    problems.push_back(fmt::format("{}: {}: got {} ({}), expected {}", value->where, table.name, value->print(),
                                   value->kindName(), fmt::format(fmt::runtime(table.isArray ? "[[{}]]" : "[{}]"), table.name)));
    return;
  }
  if (!table.isArray) {
    bindTable(table.fields(shot, 0), value, table.name, shot.file, folder, problems);
    return;
  }
  const std::size_t count = value ? value->items.size() : 0;
  table.resize(shot, count);
  for (std::size_t i = 0; i < count; ++i) {
    const ConfigValue& item = value->items[i];
    const std::string name = fmt::format("{}.{}", table.name, i);
    if (item.kind != Kind::table)
      problems.push_back(fmt::format("{}: {}: got {}, expected [[{}]]", item.where, name, item.print(), table.name));
    else
      bindTable(table.fields(shot, i), &item, name, shot.file, folder, problems);
  }
}

/// Where `table.key` was said, or the file's name.
std::string placeOf(const ConfigValue& config, const Shot& shot, const std::string& table, const std::string& key) {
  const ConfigValue* found = config.find(table);
  const ConfigValue* value = found ? found->find(key) : nullptr;
  if (value) return value->where;
  return found ? found->where : shot.file.string();
}

/// Whether there is a way for the camera through its keys.
void checkCamera(const ConfigValue& config, const Shot& shot, std::vector<std::string>& problems) {
  try {
    CameraPath(shot.scene.camera);
  } catch (const UsageError& error) {
    const ConfigValue* keys = config.find("camera.key");
    const bool ofKeys =
        keys && !keys->items.empty() && std::string_view(error.what()).starts_with("camera.key");
    problems.push_back(
        fmt::format("{}: {}", ofKeys ? keys->items.front().where : placeOf(config, shot, "camera", "shutter"),
                    error.what()));
  }
}

bool lacksMap(const TextureOptions& texture, const std::string& map) {
  return map == "emission" ? texture.emission.empty() : map == "height" && texture.height.empty();
}

/// Whether method erosion has the drawn feature maps that it is to use.
void checkFeatureMap(const ConfigValue& config, const Shot& shot, std::vector<std::string>& problems) {
  const ErosionOptions& erosion = shot.texture.erosion;
  const std::size_t files = erosion.feature_image.size(), exemplars = shot.texture.exemplar.size();
  const bool isDrawn = erosion.feature_map == "image" || (erosion.feature_map == "auto" && files > 0);
  if (shot.texture.method != "erosion" || !isDrawn || files == exemplars) return;
  problems.push_back(fmt::format(
      "{}: texture.erosion.feature_image: number of files: got {}, expected {} like texture.exemplar; name one for each "
      "exemplar, or set another feature_map",
      placeOf(config, shot, "texture.erosion", files > 0 ? "feature_image" : "feature_map"), files, exemplars));
}

/// What no single field can tell. Only called on shots whose fields are all right.
void checkTogether(const ConfigValue& config, const Shot& shot, std::vector<std::string>& problems) {
  const ShotOptions& s = shot.shot;
  if (s.first_frame > s.last_frame)
    problems.push_back(fmt::format("{}: shot.last_frame: got {}, expected at least shot.first_frame = {}",
                                   placeOf(config, shot, "shot", "last_frame"), s.last_frame, s.first_frame));
  if (s.name.empty() || s.name == "." || s.name == ".." || s.name.find('/') != std::string::npos)
    problems.push_back(fmt::format("{}: shot.name: got \"{}\", expected a name that files can have",
                                   placeOf(config, shot, "shot", "name"), s.name));
  if (readsFiles(shot.fluid) && shot.fluid.path.empty())
    problems.push_back(fmt::format("{}: fluid.path is missing: the cache's files, e.g. \"caches/dam/dam.####.{}\"",
                                   placeOf(config, shot, "fluid", "path"), shot.fluid.source == "mesh" ? "ply" : "vdb"));
  if (shot.texture.exemplar.empty() && shot.texture.method != "plain")
    problems.push_back(fmt::format("{}: texture.exemplar is missing: an example image, or texture.method = \"plain\"",
                                   placeOf(config, shot, "texture", "exemplar")));
  checkFeatureMap(config, shot, problems);
  if (shot.scene.material.displacement != 0.0 && shot.texture.height.empty())
    problems.push_back(
        fmt::format("{}: material.displacement: got {}, but no texture.height, expected the exemplar's "
                    "height map too; name it",
                    placeOf(config, shot, "material", "displacement"), shot.scene.material.displacement));
  const MaterialOptions& material = shot.scene.material;
  if (material.emission == "blackbody" && lacksMap(shot.texture, material.emission_source))
    problems.push_back(fmt::format("{}: material.emission_source: got \"{}\", expected a map that the texture has; set "
                                   "texture.{} or another source",
                                   placeOf(config, shot, "material", "emission_source"), material.emission_source,
                                   material.emission_source));
  const CameraOptions& camera = shot.scene.camera;
  if (camera.position == camera.target)
    problems.push_back(fmt::format("{}: camera.target: got the camera's own position, expected another point",
                                   placeOf(config, shot, "camera", "target")));
  else
    checkCamera(config, shot, problems);
}

void throwProblems(const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  if (problems.size() == 1) throw UsageError(problems.front());
  throw UsageError(fmt::format("{} problems in the shot:\n  {}", problems.size(), fmt::join(problems, "\n  ")));
}

}  // namespace

Shot readShot(const std::filesystem::path& file, const std::vector<std::string>& overrides,
              const std::vector<FlagSetting>& flags) {
  ConfigValue config = readConfig(file);
  liftInnerTables(config);
  std::vector<std::string> problems;
  for (const std::string& setting : overrides) applyOverride(config, setting, problems);
  for (const FlagSetting& flag : flags) applySetting(config, flag.setting, flag.flag, problems);

  Shot shot;
  shot.file = file;
  shot.shot.name = file.stem().string();
  for (const ConfigValue& item : config.items)
    if (!findTable(item.key))
      problems.push_back(
          fmt::format("{}: unknown table [{}]{}", item.where, item.key, didYouMean(item.key, tableNames())));
  for (const ShotTable& table : shotTables())
    bindOneOrMany(table, config.find(table.name), file.parent_path(), shot, problems);
  if (problems.empty()) checkTogether(config, shot, problems);
  throwProblems(problems);
  return shot;
}

FluidOptions readFluid(const std::string& path, const std::vector<std::string>& overrides) {
  ConfigValue config = emptyTable("", "");
  std::vector<std::string> problems;
  for (const std::string& setting : overrides) applyOverride(config, setting, problems);
  Shot shot;
  shot.fluid.path = path;
  if (std::filesystem::path(path).extension() == ".ply") shot.fluid.source = "mesh";
  const ConfigValue* fluid = config.find("fluid");
  bindTable(fields(shot.fluid), fluid, "fluid", path, {}, problems);
  for (const ConfigValue& item : config.items)
    if (item.key != "fluid")
      problems.push_back(fmt::format("{}: got [{}], expected [fluid] alone: there is no shot", item.where, item.key));
  throwProblems(problems);
  return shot.fluid;
}

}  // namespace ebru
