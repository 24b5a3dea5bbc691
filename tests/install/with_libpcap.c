/*
 * A program that uses libpcap beside the library: the library records the frames of a scan, libpcap reads them. Names
 * that both had would call one for the other.
 */
#include <stdio.h>

#include <cm1e/bus.h>
#include <pcap/pcap.h>

int main(void)
{
    static const char path[] = "with_libpcap.pcap";
    cm1e_bus_config_t config;
    cm1e_diag_t why = {0};
    cm1e_bus_t *bus = NULL;
    cm1e_bus_config_init(&config, "sim", 1);
    snprintf(config.pcap_file, sizeof config.pcap_file, "%s", path);
    if (cm1e_bus_open(&bus, &config, &why) != CM1E_OK || cm1e_bus_scan(bus, &why) != CM1E_OK)
        fprintf(stderr, "%s\n", why.text);
    const uint32_t slaves = cm1e_bus_slave_count(bus);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);

    char fault[PCAP_ERRBUF_SIZE] = "";
    pcap_t *file = pcap_open_offline(path, fault);
    struct pcap_pkthdr header;
    unsigned frames = 0;
    while (file && pcap_next(file, &header))
        frames++;
    if (file)
        pcap_close(file);
    printf("with libpcap: %u slave, %s\n", slaves, frames > 100 ? "its frames are read" : fault);
    return slaves == 1 && frames > 100 ? 0 : 1;
}
