#include "render/materials/albedo_tables.h"

#include "render/materials/fresnel.h"
#include "render/materials/microfacet.h"

namespace ebru {
namespace {

constexpr std::size_t cosines = BlendedRows<2>::cosines;
constexpr std::size_t stride = BlendedRows<2>::stride;
constexpr std::size_t roughnesses = 28;
constexpr std::size_t iors = 20;
constexpr std::size_t fineIors = 256;
constexpr float largestContrast = 0.6f;  ///< (n - 1) / (n + 1) for n = 4
constexpr float smallestIor = 1.002f;

float cosineAt(std::size_t i) {
  const float root = static_cast<float>(i) / static_cast<float>(cosines - 1);
  return std::max(1e-4f, root * root);
}

float roughnessAt(std::size_t i) {
  return static_cast<float>(i) / static_cast<float>(roughnesses - 1);
}

/// The root of the reflectance at normal incidence is what albedos depend on most evenly. Its own root puts
/// more of the table's entries where a coat has little contrast and so reflects only at grazing angles.
float iorAt(std::size_t i, std::size_t count) {
  const float root = static_cast<float>(i) / static_cast<float>(count - 1);
  const float contrast = root * root * largestContrast;
  return (1.0f + contrast) / (1.0f - contrast);
}

struct Cell {
  std::size_t index;  ///< of the lower neighbour
  float fraction;     ///< of the way to the next
};

Cell cellOf(float unit, std::size_t count) {
  const float x = std::clamp(unit, 0.0f, 1.0f) * static_cast<float>(count - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), count - 2);
  return {i, x - static_cast<float>(i)};
}

Cell iorCell(float ior, std::size_t count) {
  return cellOf(std::sqrt(std::max(0.0f, (ior - 1.0f) / ((ior + 1.0f) * largestContrast))), count);
}

constexpr std::size_t latticeSize = 377, latticeStep = 233;  ///< neighbours in Fibonacci's sequence
using Lanes = std::array<float, latticeSize>;

/// Points of the unit square that `Ggx::sampleVisible` is fed with, and their weights: a Fibonacci lattice.
/// The integrands are periodic in the first coordinate; u^2 (3 - 2u) makes them so in the second. No two
/// points share a coordinate, so that where total reflection sets in at one facet slope, all of them resolve
/// it.
struct Lattice {
  std::array<Vec2f, latticeSize> points;
  Lanes weights;

  Lattice() {
    constexpr double n = latticeSize;
    for (std::size_t i = 0; i < latticeSize; ++i) {
      const double u = (static_cast<double>(i) + 0.5) / n;
      points[i] = Vec2d(static_cast<double>(i * latticeStep % latticeSize) / n, u * u * (3.0 - 2.0 * u))
                      .cast<float>();
      weights[i] = static_cast<float>(6.0 * u * (1.0 - u) / n);
    }
  }
};

/// max(0, x). Without a branch, so that loops can be vectorised.
float positive(float x) {
  return 0.5f * (x + std::abs(x));
}

/// In eight parts, so that it can be vectorised without another order of the terms.
float sum(const Lanes& terms) {
  constexpr std::size_t parts = 8;
  std::array<float, parts> partial{};
  std::size_t i = 0;
  for (; i + parts <= latticeSize; i += parts)
    for (std::size_t k = 0; k < parts; ++k) partial[k] += terms[i + k];
  float result = 0.0f;
  for (const float part : partial) result += part;
  for (; i < latticeSize; ++i) result += terms[i];
  return std::max(0.0f, result);
}

/// Integrals over the facets that a viewer at one height sees. Plain loops without branches: libraries take
/// square roots of many numbers by approximations that differ between processors.
class VisibleFacets {
 public:
  VisibleFacets(const Lattice& lattice, const Ggx& facets, float viewerZ)
      : weights_(lattice.weights),
        width2_(facets.width() * facets.width()),
        viewerZ_(viewerZ),
        stretch_(facets.stretch(viewerZ)) {
    const Vec3f viewer(std::sqrt(std::max(0.0f, 1.0f - viewerZ * viewerZ)), 0.0f, viewerZ);
    for (std::size_t i = 0; i < latticeSize; ++i) {
      const Vec3f m = facets.sampleVisible(viewer, lattice.points[i]);
      z_[i] = m.z();
      cosine_[i] = std::clamp(viewer.dot(m), 1e-6f, 1.0f);
      const float light = std::max(0.0f, 2.0f * cosine_[i] * z_[i] - viewerZ);
      reflected_[i] = light * (viewerZ + stretch_) / (light * stretch_ + viewerZ * stretchOf(light));
    }
  }

  float reflectionLoss() const {
    Lanes loss;
    for (std::size_t i = 0; i < latticeSize; ++i) loss[i] = weights_[i] * (1.0f - reflected_[i]);
    return sum(loss);
  }

  struct Dielectric {
    float loss, reflected;
  };
  /// @param eta  of the side the viewer is not on, relative to his
  Dielectric dielectric(float eta) const {
    Lanes loss, reflected;
    const float back = 1.0f / eta, back2 = back * back;
    for (std::size_t i = 0; i < latticeSize; ++i) {
      // Total reflection, behind = 0, comes out as reflectance 1.
      const float c = cosine_[i], behind = std::sqrt(positive(1.0f - (1.0f - c * c) * back2));
      const float perpendicular = (c - eta * behind) / (c + eta * behind);
      const float parallel = (eta * c - behind) / (eta * c + behind);
      const float fresnel = 0.5f * (perpendicular * perpendicular + parallel * parallel);
      const float light = positive(back * viewerZ_ - (back * c - behind) * z_[i]);
      const float transmitted = 2.0f * light / (light + stretchOf(light));
      reflected[i] = weights_[i] * fresnel * reflected_[i];
      loss[i] = weights_[i] * (1.0f - fresnel * reflected_[i] - (1.0f - fresnel) * transmitted);
    }
    return {sum(loss), sum(reflected)};
  }

 private:
  float stretchOf(float z) const { return std::sqrt(z * z + width2_ * positive(1.0f - z * z)); }

  const Lanes& weights_;
  Lanes z_, cosine_, reflected_;
  float width2_, viewerZ_, stretch_;
};

/// Mean over directions, weighted with the cosine, of a row as `BlendedRows` interpolates it times a factor:
/// 4 t^3 dt with t the cosine's root, by Gauss with three points, which is exact for a factor of 1.
template <typename Factor>
float meanOf(const float* row, Factor&& factor) {
  static const std::array<double, 3> places = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  static constexpr std::array<double, 3> shares = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double step = 1.0 / static_cast<double>(cosines - 1);
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < cosines; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double f = places[k], root = (static_cast<double>(i) + f) * step;
      const double value = (1.0 - f) * row[i] + f * row[i + 1];
      sum += shares[k] * step * 4.0 * root * root * root * value * factor(root * root);
    }
  return static_cast<float>(sum);
}

double unweighted(double /*cosine*/) {
  return 1.0;
}

std::size_t offset(std::size_t ior, std::size_t roughness) {
  return (ior * roughnesses + roughness) * stride;
}

BlendedRows<4> blend(const std::vector<float>& table, float roughness, float ior) {
  const Cell r = cellOf(roughness, roughnesses), n = iorCell(ior, iors);
  const float* first = table.data() + offset(n.index, r.index);
  constexpr std::size_t next = roughnesses * stride;
  const float a = r.fraction, b = n.fraction;
  return {{first, first + stride, first + next, first + next + stride},
          {(1.0f - a) * (1.0f - b), a * (1.0f - b), (1.0f - a) * b, a * b}};
}

}  // namespace

const AlbedoTables& AlbedoTables::get() {
  static const AlbedoTables tables;
  return tables;
}

AlbedoTables::AlbedoTables()
    : reflectionLoss_(roughnesses * stride),
      coatAlbedo_(iors * roughnesses * stride),
      fresnelMean_(fineIors) {
  for (auto& table : dielectricLoss_) table.resize(iors * roughnesses * stride);
  for (std::size_t r = 0; r < roughnesses; ++r)
    for (std::size_t c = 0; c < cosines; ++c) integrate(r, c);
  average();
}

void AlbedoTables::integrate(std::size_t roughness, std::size_t cosine) {
  static const Lattice lattice;
  const float r = roughnessAt(roughness), z = cosineAt(cosine);
  const VisibleFacets facets(lattice, Ggx(r * r), z);
  reflectionLoss_[roughness * stride + cosine] = facets.reflectionLoss();
  for (std::size_t i = 0; i < iors; ++i) {
    // Albedos relative to Fresnel's reflectance have a limit where both vanish.
    const float ior = std::max(smallestIor, iorAt(i, iors));
    const std::size_t entry = offset(i, roughness) + cosine;
    const VisibleFacets::Dielectric outside = facets.dielectric(ior);
    dielectricLoss_[0][entry] = outside.loss;
    dielectricLoss_[1][entry] = facets.dielectric(1.0f / ior).loss;
    coatAlbedo_[entry] = outside.reflected / fresnelDielectric(z, ior);
  }
}

void AlbedoTables::average() {
  for (std::size_t r = 0; r < roughnesses; ++r) {
    float* row = &reflectionLoss_[r * stride];
    row[cosines] = meanOf(row, unweighted);
  }
  const auto fresnelOf = [](float ior) {
    return [ior](double cosine) {
      return static_cast<double>(fresnelDielectric(static_cast<float>(cosine), ior));
    };
  };
  std::array<float, cosines> ones;
  ones.fill(1.0f);
  for (std::size_t i = 0; i < fineIors; ++i)
    fresnelMean_[i] = meanOf(ones.data(), fresnelOf(iorAt(i, fineIors)));
  for (std::size_t i = 0; i < iors; ++i) {
    const float ior = std::max(smallestIor, iorAt(i, iors));
    const float all = meanOf(ones.data(), fresnelOf(ior));
    for (std::size_t r = 0; r < roughnesses; ++r) {
      const std::size_t entry = offset(i, r);
      for (auto& table : dielectricLoss_) table[entry + cosines] = meanOf(&table[entry], unweighted);
      coatAlbedo_[entry + cosines] = meanOf(&coatAlbedo_[entry], fresnelOf(ior)) / all;
    }
  }
}

BlendedRows<2> AlbedoTables::reflectionLoss(float roughness) const {
  const Cell r = cellOf(roughness, roughnesses);
  const float* first = reflectionLoss_.data() + r.index * stride;
  return {{first, first + stride}, {1.0f - r.fraction, r.fraction}};
}

BlendedRows<4> AlbedoTables::dielectricLoss(float roughness, float ior, bool inside) const {
  return blend(dielectricLoss_[inside ? 1 : 0], roughness, ior);
}

BlendedRows<4> AlbedoTables::coatAlbedo(float roughness, float ior) const {
  return blend(coatAlbedo_, roughness, ior);
}

float AlbedoTables::fresnelMean(float ior) const {
  const Cell n = iorCell(ior, fineIors);
  return fresnelMean_[n.index] + n.fraction * (fresnelMean_[n.index + 1] - fresnelMean_[n.index]);
}

}  // namespace ebru
