#include "texturing/plain_method.h"

namespace ebru {
namespace {

class PlainField : public TextureField {
 public:
  TextureSample lookup(const SurfacePoint&) const override { return {}; }
};

class PlainMethod : public TextureMethod {
 public:
  void start(const FluidFrame&) override {}
  void advance(const FluidFrame&, const FluidFrame&, FramesAhead) override {}
  std::shared_ptr<const TextureField> field() const override { return field_; }
  void save(StateWriter&) const override {}
  void load(const StateReader&) override {}

 private:
  std::shared_ptr<const TextureField> field_ = std::make_shared<PlainField>();
};

}  // namespace

std::unique_ptr<TextureMethod> makePlainMethod(const TextureOptions&, std::uint64_t, PhaseTimes*) {
  return std::make_unique<PlainMethod>();
}

}  // namespace ebru
