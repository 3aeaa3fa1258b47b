#include "texturing/open_exemplar.h"

namespace ebru {

std::shared_ptr<const Exemplar> openExemplar(const TextureOptions& options) {
  const ExemplarFiles files{options.exemplar, options.height, options.roughness, options.alpha, options.emission};
  ChannelWeights weights;
  weights.colour = static_cast<float>(options.weight_colour);
  weights.height = static_cast<float>(options.weight_height);
  weights.roughness = static_cast<float>(options.weight_roughness);
  weights.alpha = static_cast<float>(options.weight_alpha);
  weights.emission = static_cast<float>(options.weight_emission);
  return std::make_shared<const Exemplar>(readExemplarMaps(files), weights);
}

}  // namespace ebru
