#include "layer_plan.h"

#include <cmath>
#include <fmt/format.h>
#include <functional>

#include "error.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

constexpr std::uint32_t most_layers = 64; // loops over them are short, see plan.h

// Sums of a layer over the samples of a pixel.
struct Sums {
    glm::dvec3 value, square;
};

Sums sums_of(std::span<const glm::vec3> sums, std::size_t i) {
    const auto pair = [&](std::size_t k) { return glm::dvec3(sums[4 * i + k]) + glm::dvec3(sums[4 * i + k + 1]); };
    return {pair(0), pair(2)};
}

// Makes layers of what lies at the slots of each record. All layers of a pixel are made in turn: records are large, and
// each is read but once.
class Developer {
public:
    Developer(const LayerPlan& plan, std::span<const glm::vec3> sums, std::span<const std::uint32_t> samples)
        : plan_(plan), sums_(sums), samples_(samples) {}

    // Means over all samples.
    void add_means(const std::string& name, std::uint32_t slot) {
        add(name, true, [this, slot](std::size_t i) { return mean_of(i, slot); });
    }

    void add_alpha(std::uint32_t slot) {
        add("alpha", true, [this, slot](std::size_t i) {
            const Value through = mean_of(i, slot);
            return Value{samples_[i] > 0 ? 1.0f - through.mean : glm::vec3(0.0f), through.variance};
        });
    }

    void add_coverage(std::uint32_t slot) {
        add("coverage", true, [this, slot](std::size_t i) {
            const Value collided = mean_of(i, slot);
            return Value{glm::vec3(collided.mean.y), glm::vec3(collided.variance.y)};
        });
    }

    // Sum of w d over sum of w, over the samples that collide: a quotient, whose variance is that of w (d - mean) over
    // the mean of w squared, to first order (Cochran, "Sampling Techniques", 1977, ch. 6).
    void add_depth(std::uint32_t slot) {
        add("depth", true, [this, slot](std::size_t i) {
            const double n = samples_[i];
            const Sums s = at(i, slot);
            const double w = s.value.y, m = w > 0.0 ? s.value.x / w : 0.0;
            const double spread = s.square.x - 2.0 * m * s.value.z + m * m * s.square.y; // z: of w d times w
            const double variance = n > 1 && w > 0.0 ? n / (n - 1.0) * spread / (w * w) : 0.0;
            return Value{glm::vec3(static_cast<float>(m)), glm::vec3(static_cast<float>(std::max(variance, 0.0)))};
        });
    }

    void add_position(std::uint32_t slot, const glm::dvec3& origin) {
        add("position", false, [this, slot, origin](std::size_t i) {
            const double w = at(i, slot).value.y;
            return Value{w > 0.0 ? at(i, slot + 1).value / w + origin : glm::dvec3(0.0), {}};
        });
    }

    std::vector<FilmLayer> develop() {
        for (std::size_t i = 0; i < samples_.size(); ++i)
            for (std::size_t k = 0; k < layers_.size(); ++k) {
                const Value value = values_[k](i);
                layers_[k].mean[i] = value.mean;
                if (!layers_[k].variance.empty())
                    layers_[k].variance[i] = value.variance;
            }
        return std::move(layers_);
    }

private:
    struct Value {
        glm::vec3 mean, variance;
    };

    void add(const std::string& name, bool has_variance, std::function<Value(std::size_t)> value) {
        layers_.push_back({name, std::vector<glm::vec3>(samples_.size()),
                           std::vector<glm::vec3>(has_variance ? samples_.size() : 0)});
        values_.push_back(std::move(value));
    }

    Sums at(std::size_t pixel, std::uint32_t slot) const { return sums_of(sums_, pixel * plan_.params.count + slot); }

    Value mean_of(std::size_t i, std::uint32_t slot) const {
        const double n = samples_[i];
        const Sums s = at(i, slot);
        const glm::dvec3 mean = n > 0 ? s.value / n : glm::dvec3(0.0);
        const glm::dvec3 variance = n > 1 ? (s.square / n - mean * mean) / (n - 1.0) : glm::dvec3(0.0);
        return {mean, glm::max(variance, glm::dvec3(0.0))};
    }

    const LayerPlan& plan_;
    std::span<const glm::vec3> sums_;
    std::span<const std::uint32_t> samples_; // of each pixel
    std::vector<FilmLayer> layers_;
    std::vector<std::function<Value(std::size_t)>> values_; // of each of them at a pixel
};

} // namespace

LayerPlan plan_layers(const Scene& scene) {
    LayerPlan plan;
    plan.wanted = scene.layers;
    plan.kinds = scene.holds_out ? LAYERS_HOLDOUT : 0;
    shared::AovParams& params = plan.params;
    const auto place = [&](unsigned layers, int kind, std::uint32_t& first, std::size_t count) {
        if ((scene.layers & layers) == 0)
            return;
        plan.kinds |= kind;
        first = params.count;
        params.count += static_cast<std::uint32_t>(count);
    };
    std::uint32_t kinds = 0; // the first
    place(layer_background | layer_emission | layer_direct | layer_indirect, LAYERS_KINDS, kinds, SCATTERED_KINDS);
    if (scene.layers & layer_groups)
        plan.groups = light_groups(scene);
    place(layer_groups, LAYERS_GROUPS, params.groups, 1 + plan.groups.size());
    if (scene.layers & layer_media)
        plan.media = medium_names(scene);
    if (!plan.media.empty())
        place(layer_media, LAYERS_MEDIA, params.media, plan.media.size());
    place(layer_depth | layer_position, LAYERS_COLLISION, params.collision, 2);
    place(layer_albedo, LAYERS_ALBEDO, params.albedo, 1);
    place(layer_transmittance | layer_alpha, LAYERS_THROUGH, params.through, 2);
    place(layer_normal, LAYERS_NORMAL, params.normal, 1);
    if (params.count > most_layers)
        throw InputError(
            fmt::format("the picture's layers would take {} places, {} of them for groups of lights and {} "
                        "for media, but {} is the most; give several one name, or leave a layer out",
                        params.count, plan.groups.size(), plan.media.size(), most_layers));
    return plan;
}

std::uint32_t group_layer(const std::vector<std::string>& groups, const std::string& group) {
    return group.empty() || groups.empty() ? 0 : 1 + place_among(groups, group);
}

std::vector<std::string> media_layers(const Scene& scene) {
    return scene.layers & layer_media ? medium_names(scene) : std::vector<std::string>{};
}

std::uint32_t media_layer(const std::vector<std::string>& layers, const Scene& scene, std::size_t volume) {
    return layers.empty() ? 0 : place_among(layers, medium_name(scene, volume));
}

std::vector<FilmLayer> develop_layers(const LayerPlan& plan, std::span<const glm::vec3> sums,
                                      std::span<const std::uint32_t> samples, const glm::dvec3& origin) {
    Developer developer(plan, sums, samples);
    const shared::AovParams& params = plan.params;
    for (std::uint32_t kind = 0; kind < SCATTERED_KINDS; ++kind)
        if (plan.wanted & 1u << kind)
            developer.add_means(layer_names()[kind], kind);
    if (plan.kinds & LAYERS_GROUPS)
        developer.add_means("group.none", params.groups);
    for (std::size_t i = 0; i < plan.groups.size(); ++i)
        developer.add_means("group." + plan.groups[i], params.groups + 1 + std::uint32_t(i));
    for (std::size_t i = 0; i < plan.media.size(); ++i)
        developer.add_means("medium." + plan.media[i], params.media + std::uint32_t(i));
    if (plan.wanted & layer_depth)
        developer.add_depth(params.collision);
    if (plan.wanted & layer_position)
        developer.add_position(params.collision, origin);
    if (plan.kinds & LAYERS_COLLISION)
        developer.add_coverage(params.collision);
    if (plan.wanted & layer_albedo)
        developer.add_means("albedo", params.albedo);
    if (plan.wanted & layer_transmittance)
        developer.add_means("transmittance", params.through);
    if (plan.wanted & layer_alpha)
        developer.add_alpha(params.through + 1);
    if (plan.wanted & layer_normal)
        developer.add_means("normal", params.normal);
    return developer.develop();
}

} // namespace vkvol
