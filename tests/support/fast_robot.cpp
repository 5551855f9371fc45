// A robot on Fast DDS without ROS: it tells where it is, and goes where it is sent; with DDS Security by an enclave.
// Arguments: name, domain, folder of the enclave or "". Each target and each speed 0 is a line of JSON.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

using Bytes = std::vector<unsigned char>;

// The bytes of a message under any type's name.
class Raw : public TopicDataType {
public:
    explicit Raw(const std::string& name) {
        setName(name.c_str());
        m_typeSize = 4096;
        m_isGetKeyDefined = false;
        auto_fill_type_information(false);
        auto_fill_type_object(false);
    }
    bool serialize(void* data, SerializedPayload_t* payload) override {
        const Bytes& bytes = *static_cast<Bytes*>(data);
        std::memcpy(payload->data, bytes.data(), bytes.size());
        payload->length = static_cast<uint32_t>(bytes.size());
        payload->encapsulation = CDR_LE;
        return true;
    }
    bool deserialize(SerializedPayload_t* payload, void* data) override {
        static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] { return static_cast<uint32_t>(static_cast<Bytes*>(data)->size()); };
    }
    void* createData() override { return new Bytes; }
    void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
    bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

// CDR, little-endian; places are counted from behind the encapsulation.
struct Cdr {
    Bytes bytes{0, 1, 0, 0};
    template <class T> void put(T value) {
        while ((bytes.size() - 4) % sizeof(T)) bytes.push_back(0);
        const auto* from = reinterpret_cast<unsigned char*>(&value);
        bytes.insert(bytes.end(), from, from + sizeof(T));
    }
    void put_text(const std::string& text) {
        put<uint32_t>(static_cast<uint32_t>(text.size() + 1));
        bytes.insert(bytes.end(), text.begin(), text.end());
        bytes.push_back(0);
    }
};

static Bytes odometry(double x, double y, double v) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const long long ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
    Cdr out;
    out.put<int32_t>(static_cast<int32_t>(ns / 1000000000));
    out.put<uint32_t>(static_cast<uint32_t>(ns % 1000000000));
    out.put_text("map");
    out.put_text("base_link");
    for (double one : {x, y, 0.0, 0.0, 0.0, 0.0, 1.0}) out.put(one);
    for (int i = 0; i < 36; i++) out.put(0.0);
    for (double one : {v, 0.0, 0.0, 0.0, 0.0, 0.0}) out.put(one);
    for (int i = 0; i < 36; i++) out.put(0.0);
    return out.bytes;
}

// The place in a PoseStamped; false where it is none.
static bool place(const Bytes& bytes, double& x, double& y) {
    uint32_t length = 0;
    if (bytes.size() < 16) return false;
    std::memcpy(&length, &bytes[12], 4);
    const size_t at = 4 + ((12 + static_cast<size_t>(length) + 7) & ~size_t{7});
    if (bytes.size() < at + 16) return false;
    std::memcpy(&x, &bytes[at], 8);
    std::memcpy(&y, &bytes[at + 8], 8);
    return true;
}

static void secure(DomainParticipantQos& qos, const std::string& enclave) {
    const auto set = [&](const std::string& key, const std::string& value) {
        qos.properties().properties().emplace_back("dds.sec." + key, value);
    };
    const auto file = [&](const std::string& key, const std::string& name) { set(key, "file://" + enclave + "/" + name); };
    set("auth.plugin", "builtin.PKI-DH");
    file("auth.builtin.PKI-DH.identity_ca", "identity_ca.cert.pem");
    file("auth.builtin.PKI-DH.identity_certificate", "cert.pem");
    file("auth.builtin.PKI-DH.private_key", "key.pem");
    set("crypto.plugin", "builtin.AES-GCM-GMAC");
    set("access.plugin", "builtin.Access-Permissions");
    file("access.builtin.Access-Permissions.permissions_ca", "permissions_ca.cert.pem");
    file("access.builtin.Access-Permissions.governance", "governance.p7s");
    file("access.builtin.Access-Permissions.permissions", "permissions.p7s");
}

int main(int, char** given) {
    const std::string name = given[1], enclave = given[3];
    DomainParticipantQos qos;
    auto here = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    here->interfaceWhiteList.push_back("127.0.0.1");
    here->maxInitialPeersRange = 100;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(here);
    Locator_t peer;
    eprosima::fastrtps::rtps::IPLocator::setIPv4(peer, 127, 0, 0, 1);
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    if (!enclave.empty()) secure(qos, enclave);
    auto* participant = DomainParticipantFactory::get_instance()->create_participant(std::stoi(given[2]), qos);
    if (participant == nullptr) return 1;
    const auto topic = [&](const std::string& last, const std::string& package, const std::string& type) {
        TypeSupport kind(new Raw(package + "::msg::dds_::" + type + "_"));
        kind.register_type(participant);
        return participant->create_topic("rt/" + name + "/" + last, kind.get_type_name(), TOPIC_QOS_DEFAULT);
    };
    DataWriterQos writing;
    writing.data_sharing().off();
    DataReaderQos reading;
    reading.data_sharing().off();
    reading.reliability().kind = RELIABLE_RELIABILITY_QOS;
    auto* publisher = participant->create_publisher(PUBLISHER_QOS_DEFAULT);
    auto* subscriber = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
    auto* places = publisher->create_datawriter(topic("odom", "nav_msgs", "Odometry"), writing);
    auto* targets = subscriber->create_datareader(topic("goal_pose", "geometry_msgs", "PoseStamped"), reading);
    auto* speeds = subscriber->create_datareader(topic("cmd_vel", "geometry_msgs", "Twist"), reading);
    if (places == nullptr || targets == nullptr || speeds == nullptr) return 1;
    std::puts("{\"event\": \"up\"}");
    std::fflush(stdout);
    double x = 20.0, y = 8.0, to_x = 20.0, to_y = 8.0;
    bool drives = false;
    while (true) {
        Bytes came;
        SampleInfo info;
        while (targets->take_next_sample(&came, &info) == ReturnCode_t::RETCODE_OK)
            if (info.valid_data && place(came, to_x, to_y)) {
                drives = true;
                std::printf("{\"event\": \"target\", \"x\": %f, \"y\": %f}\n", to_x, to_y);
            }
        while (speeds->take_next_sample(&came, &info) == ReturnCode_t::RETCODE_OK)
            if (info.valid_data && drives) {
                drives = false;
                std::puts("{\"event\": \"speed 0\"}");
            }
        std::fflush(stdout);
        const double left = std::hypot(to_x - x, to_y - y), step = drives ? std::min(left, 0.4) : 0.0;
        if (left > 0) {
            x += (to_x - x) / left * step;
            y += (to_y - y) / left * step;
        }
        Bytes told = odometry(x, y, step * 10);
        places->write(&told);
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}
