/**
 * @file service_notify.h
 * Tells systemd how far a service is (sd_notify(3)), without libsystemd. Where systemd did not start this program, or
 * does not want to be told, nothing happens.
 */
#ifndef CM1E_TOOLS_SERVICE_NOTIFY_H
#define CM1E_TOOLS_SERVICE_NOTIFY_H

/** Sends one or more lines: "READY=1\nSTATUS=in operation". */
void service_notify(const char *lines);

#endif
