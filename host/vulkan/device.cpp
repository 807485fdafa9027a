#include "device.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <mutex>
#include <optional>

#include "pipeline_cache.h"
#include "pipeline_layout.h"
#include "pipelines.h"
#include "shared/constants.h"
#include "vulkan_error.h"

namespace vkvol {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

std::string version_text(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

const char* type_name(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "cpu";
    default:
        return "other";
    }
}

// Rather a real GPU than a software driver, of GPUs one whose driver has passed Vulkan's tests, a discrete one, one of
// much memory.
bool is_better(const DeviceInfo& a, const DeviceInfo& b) {
    constexpr std::array order = {"discrete", "integrated", "virtual", "other", "cpu"};
    const auto rank = [&](const DeviceInfo& info) {
        const auto kind = std::find(order.begin(), order.end(), info.type) - order.begin();
        return std::tuple(info.type == "cpu", !info.conformant, kind, ~info.memory);
    };
    return rank(a) < rank(b);
}

std::optional<std::uint32_t> find_compute_family(VkPhysicalDevice physical, std::uint32_t* timestamp_bits = nullptr) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    // Rather one that draws nothing: what does is the desktop's as well, which would wait for each submit.
    std::optional<std::uint32_t> found;
    for (std::uint32_t i = 0; i < count; ++i) {
        const VkQueueFlags flags = families[i].queueFlags;
        if ((flags & VK_QUEUE_COMPUTE_BIT) && (!found || !(flags & VK_QUEUE_GRAPHICS_BIT)))
            if (!found || (families[*found].queueFlags & VK_QUEUE_GRAPHICS_BIT))
                found = i;
    }
    if (found && timestamp_bits)
        *timestamp_bits = families[*found].timestampValidBits;
    return found;
}

VkPhysicalDeviceVulkan12Features features_of(VkPhysicalDevice physical) {
    VkPhysicalDeviceVulkan12Features features12{};
    features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &features12;
    vkGetPhysicalDeviceFeatures2(physical, &features);
    return features12;
}

constexpr std::array ray_query_extensions{VK_KHR_RAY_QUERY_EXTENSION_NAME, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                          VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

// Those of ray queries, which are asked after and asked for in the same words.
struct RayQueryFeatures {
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures{};
    VkPhysicalDeviceRayQueryFeaturesKHR queries{};

    RayQueryFeatures() {
        structures.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
        structures.pNext = &queries;
        queries.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    }
};

bool offers_ray_queries(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
    const bool has_all = std::ranges::all_of(ray_query_extensions, [&](const char* name) {
        return std::ranges::any_of(extensions, [&](const VkExtensionProperties& extension) {
            return std::strcmp(extension.extensionName, name) == 0;
        });
    });
    if (!has_all)
        return false;
    RayQueryFeatures asked;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &asked.structures;
    vkGetPhysicalDeviceFeatures2(physical, &features);
    return asked.structures.accelerationStructure && asked.queries.rayQuery;
}

std::string find_rejection(VkPhysicalDevice physical, const VkPhysicalDeviceProperties& properties) {
    if (properties.apiVersion < VK_API_VERSION_1_2)
        return fmt::format("it offers Vulkan {}, at least 1.2 is needed", version_text(properties.apiVersion));
    if (!find_compute_family(physical))
        return "it has no compute queue";
    if (!features_of(physical).scalarBlockLayout)
        return "it lacks the feature scalarBlockLayout";
    constexpr std::uint32_t needed = BINDING_BUFFERS - 1; // but the frame's
    const VkPhysicalDeviceLimits& limits = properties.limits;
    const std::uint32_t most =
        std::min(limits.maxPerStageDescriptorStorageBuffers, limits.maxDescriptorSetStorageBuffers);
    if (most < needed)
        return fmt::format("it lets kernels see {} storage buffers, at least {} are needed", most, needed);
    return "";
}

DeviceInfo describe(VkPhysicalDevice physical, int index) {
    VkPhysicalDeviceVulkan12Properties properties12{};
    properties12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
    VkPhysicalDeviceIDProperties id{};
    id.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES;
    id.pNext = &properties12;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &id;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    DeviceInfo info;
    info.index = index;
    info.name = properties.properties.deviceName;
    info.type = type_name(properties.properties.deviceType);
    info.api = version_text(properties.properties.apiVersion);
    info.driver = fmt::format("{} {}", properties12.driverName, properties12.driverInfo);
    if (properties12.driverID == VK_DRIVER_ID_MESA_LLVMPIPE)
        std::sscanf(properties12.driverInfo, "Mesa %u", &info.lavapipe);
    info.swiftshader = properties12.driverID == VK_DRIVER_ID_GOOGLE_SWIFTSHADER;
    const VkConformanceVersion& tests = properties12.conformanceVersion;
    info.conformant = tests.major != 0 || tests.minor != 0;
    info.storage_range = properties.properties.limits.maxStorageBufferRange;
    for (std::uint8_t byte : id.deviceUUID)
        info.uuid += fmt::format("{:02x}", byte);
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            info.memory += memory.memoryHeaps[i].size;
    info.rejection = find_rejection(physical, properties.properties);
    info.addresses = info.rejection.empty() && features_of(physical).bufferDeviceAddress;
    info.ray_queries = info.addresses && offers_ray_queries(physical);
    return info;
}

std::vector<VkPhysicalDevice> enumerate(VkInstance instance) {
    const auto check = [](VkResult result) {
        if (result < 0)
            throw DeviceError(fmt::format(
                "the Vulkan drivers do not list their devices: {}; does `vulkaninfo` show any?", result_name(result)));
    };
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr));
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()));
    devices.resize(count); // some may have gone
    return devices;
}

VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static std::mutex mutex; // kernels are compiled on several threads
    const std::scoped_lock lock(mutex);
    static_cast<std::vector<std::string>*>(user)->push_back(data->pMessage);
    return VK_FALSE;
}

template <class Function> Function instance_function(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

bool has_layer(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(),
                       [&](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

VkInstance make_instance(bool validate, VkDebugUtilsMessengerCreateInfoEXT* messenger) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "vkvol";
    application.apiVersion = VK_API_VERSION_1_2;
    const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.pNext = messenger;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &enabled;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkInstanceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    create.pApplicationInfo = &application;
    if (validate) {
        create.pNext = &features;
        create.enabledLayerCount = 1;
        create.ppEnabledLayerNames = &validation_layer;
        create.enabledExtensionCount = 1;
        create.ppEnabledExtensionNames = &extension;
    }
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&create, nullptr, &instance);
    if (result != VK_SUCCESS)
        throw DeviceError(fmt::format("no Vulkan driver answers ({}); on Debian, `apt install mesa-vulkan-drivers` "
                                      "brings a software driver that runs anywhere",
                                      result_name(result)));
    return instance;
}

bool matches(const DeviceInfo& info, const std::string& choice) {
    if (choice == "auto")
        return true;
    if (choice == "cpu")
        return info.type == "cpu";
    if (choice.empty()) // as a variable is that is not set
        return false;
    if (std::all_of(choice.begin(), choice.end(), [](unsigned char c) { return std::isdigit(c); }) && choice.size() < 4)
        return info.index == std::stoi(choice);
    const auto lower = [](std::string text) {
        std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
        return text;
    };
    std::string plain = lower(choice);
    if (lower(info.name).find(plain) != std::string::npos)
        return true;
    plain.erase(std::remove(plain.begin(), plain.end(), '-'), plain.end());
    return info.uuid == plain;
}

} // namespace

std::vector<DeviceInfo> list_devices() {
    VkInstance instance = make_instance(false, nullptr);
    std::vector<DeviceInfo> infos;
    for (VkPhysicalDevice physical : enumerate(instance))
        infos.push_back(describe(physical, static_cast<int>(infos.size())));
    vkDestroyInstance(instance, nullptr);
    return infos;
}

std::vector<DeviceOptions> each_device(const DeviceOptions& options) {
    std::string list = options.choice;
    list.erase(std::remove(list.begin(), list.end(), ' '), list.end());
    const bool is_list =
        list.find(',') != std::string::npos &&
        std::all_of(list.begin(), list.end(), [](unsigned char c) { return std::isdigit(c) || c == ','; });
    if (!is_list)
        return {options};
    std::vector<DeviceOptions> each;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        if (begin == end)
            throw InputError(fmt::format("--device {}: a number is missing; two devices are 0,1", list));
        DeviceOptions& one = each.emplace_back(options);
        one.choice = list.substr(begin, end - begin);
        begin = end + 1;
    }
    return each;
}

Device::Device(const DeviceOptions& options) {
    if (each_device(options).size() > 1)
        throw InputError(
            fmt::format("--device {}: several devices share renders to files alone; name one", options.choice));
    forgo_driver_cache_on_full_disk();
    try {
        create_instance(options);
        choose_physical(options.choice);
        create_device(options);
    } catch (...) {
        destroy();
        throw;
    }
}

void Device::create_instance(const DeviceOptions& options) {
    if (!options.validate) {
        instance_ = make_instance(false, nullptr);
        return;
    }
    if (!has_layer(validation_layer))
        throw DeviceError("--validate needs the Khronos validation layer; on Debian, "
                          "`apt install vulkan-validationlayers` brings it");
    VkDebugUtilsMessengerCreateInfoEXT messenger{};
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = on_message;
    messenger.pUserData = &messages_;
    instance_ = make_instance(true, &messenger);
    const auto create =
        instance_function<PFN_vkCreateDebugUtilsMessengerEXT>(instance_, "vkCreateDebugUtilsMessengerEXT");
    VK_CHECK(create(instance_, &messenger, nullptr, &messenger_));
}

void Device::choose_physical(const std::string& choice) {
    const std::vector<VkPhysicalDevice> devices = enumerate(instance_);
    std::string reasons;
    int best = -1;
    for (int i = 0; i < static_cast<int>(devices.size()); ++i) {
        const DeviceInfo info = describe(devices[i], i);
        std::string reason = info.rejection;
        if (reason.empty() && !matches(info, choice))
            reason = fmt::format("it does not match --device {}", choice);
        if (!reason.empty())
            reasons += fmt::format("; {} \"{}\": {}", i, info.name, reason);
        else if (best < 0 || is_better(info, info_)) {
            best = i;
            info_ = info;
        }
    }
    if (best < 0)
        throw DeviceError(devices.empty() ? "no Vulkan device found; on Debian, `apt install mesa-vulkan-drivers` "
                                            "brings a software driver that runs anywhere"
                                          : fmt::format("no usable device for --device {}{}; `vkvol devices` lists "
                                                        "what there is",
                                                        choice, reasons));
    physical_ = devices[best];
    VkPhysicalDeviceMaintenance3Properties allocations{};
    allocations.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
    VkPhysicalDeviceAccelerationStructurePropertiesKHR boxes{};
    boxes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    if (info_.ray_queries)
        allocations.pNext = &boxes;
    VkPhysicalDeviceProperties2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    all.pNext = &allocations;
    vkGetPhysicalDeviceProperties2(physical_, &all);
    properties_ = all.properties;
    most_allocation_ = allocations.maxMemoryAllocationSize;
    box_limits_ = {boxes.maxPrimitiveCount, std::max(boxes.minAccelerationStructureScratchOffsetAlignment, 1u)};
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
}

std::uint64_t Device::ticks_between(std::uint64_t first, std::uint64_t second) const {
    const std::uint64_t valid = timestamp_bits_ >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << timestamp_bits_) - 1;
    return (second - first) & valid;
}

void Device::create_device(const DeviceOptions& options) {
    queue_family_ = find_compute_family(physical_, &timestamp_bits_).value();
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan12Features features12{};
    features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features12.scalarBlockLayout = VK_TRUE;
    features12.bufferDeviceAddress = info_.addresses;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &features12;
    features.features.robustBufferAccess = options.robust;
    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = &features;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    RayQueryFeatures ray_queries;
    has_ray_queries_ = options.ray_queries && info_.ray_queries;
    if (has_ray_queries_) {
        ray_queries.structures.accelerationStructure = VK_TRUE;
        ray_queries.queries.rayQuery = VK_TRUE;
        features12.pNext = &ray_queries.structures;
        create.enabledExtensionCount = ray_query_extensions.size();
        create.ppEnabledExtensionNames = ray_query_extensions.data();
    }
    if (const VkResult result = vkCreateDevice(physical_, &create, nullptr, &device_); result != VK_SUCCESS)
        throw DeviceError(fmt::format("\"{}\" cannot be opened: {}; is another program using it up? --device names "
                                      "another (`vkvol devices` lists them)",
                                      info_.name, result_name(result)));
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    layout_ = std::make_unique<PipelineLayout>(device_, has_ray_queries_);
    pipelines_ = std::make_unique<Pipelines>(device_, *layout_, info_.swiftshader);
}

Device::~Device() {
    destroy();
}

void Device::destroy() {
    pipelines_.reset();
    layout_.reset();
    if (device_)
        vkDestroyDevice(device_, nullptr);
    if (messenger_)
        instance_function<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(
            instance_, messenger_, nullptr);
    if (instance_)
        vkDestroyInstance(instance_, nullptr);
}

int Device::find_memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
        if ((allowed >> i & 1u) && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted)
            return static_cast<int>(i);
    return -1;
}

} // namespace vkvol
