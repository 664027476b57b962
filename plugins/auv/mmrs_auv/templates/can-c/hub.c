/* The drives as a program on a computer: a client of a hub that speaks the socketcand protocol.
 *
 * drives HOST PORT [CHANNEL]
 *
 * Waits five seconds for the hub. Ends with 0 at SIGTERM or SIGINT, with 2 where its words are wrong, with 3
 * where there is no hub or the bus is gone.
 */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <netdb.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "drives.h"

#define TICK 10000u /* microseconds */
#define PATIENCE 5000000u
#define STALL (5u * TICK) /* between two readings of the clock; more was a stall */
#define LONGEST_WORD 128u

enum { ENDED = 0, WRONG_WORDS = 2, BUS_GONE = 3 };

struct client {
    int socket;
    char word[LONGEST_WORD];
    size_t length;
    const char *channel;
    int answers; /* to what opens the channel: hi, ok, ok */
};

static volatile sig_atomic_t ends = 0;

static void end(int number)
{
    (void)number;
    ends = 1;
}

static uint32_t microseconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint32_t)((uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u);
}

/* Return the time without stalls of this program: what came meanwhile still waits to be heard, so that they are
 * nobody's silence. */
static uint32_t awake(void)
{
    static uint32_t now, seen;
    const uint32_t gone = microseconds() - seen;
    seen += gone;
    now += gone < STALL ? gone : STALL;
    return now;
}

/* Return false if the bus is gone; what finds no room is let go, for the bus must not stop the watchdogs. */
static bool say(const struct client *client, const char *word)
{
    const size_t length = strlen(word);
    const ssize_t sent = send(client->socket, word, length, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0) {
        return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    }
    return (size_t)sent == length;
}

static bool say_frame(const struct client *client, const struct drives_frame *frame)
{
    char word[LONGEST_WORD];
    int at = snprintf(word, sizeof word, "< send %x %u", (unsigned)frame->id, (unsigned)frame->length);
    for (size_t i = 0; i < frame->length; i++) {
        at += snprintf(word + at, sizeof word - (size_t)at, " %x", (unsigned)frame->data[i]);
    }
    (void)snprintf(word + at, sizeof word - (size_t)at, " >");
    return say(client, word);
}

static bool frame_of(const char *word, struct drives_frame *frame)
{
    char id[9];
    char data[17] = "";
    if (sscanf(word, " < frame %8[0-9A-Fa-f] %*31s %16[0-9A-Fa-f]", id, data) < 1) {
        return false;
    }
    frame->id = (uint32_t)strtoul(id, NULL, 16);
    frame->extended = strlen(id) > 3u;
    frame->length = (uint8_t)(strlen(data) / 2u);
    for (size_t i = 0; i < frame->length; i++) {
        const char byte[3] = {data[2u * i], data[2u * i + 1u], '\0'};
        frame->data[i] = (uint8_t)strtoul(byte, NULL, 16);
    }
    return true;
}

static bool hear_word(struct client *client, struct drives *drives)
{
    struct drives_frame frame;
    char word[LONGEST_WORD];
    if (client->answers < 3) {
        const char *wanted = client->answers == 0 ? "< hi >" : "< ok >";
        if (strstr(client->word, wanted) == NULL) {
            return false;
        }
        client->answers++;
        if (client->answers == 1) {
            (void)snprintf(word, sizeof word, "< open %s >", client->channel);
            return say(client, word);
        }
        return client->answers == 2 ? say(client, "< rawmode >") : true;
    }
    if (frame_of(client->word, &frame)) {
        drives_hear(drives, &frame, awake());
    }
    return true;
}

/* Return false if the bus is gone. */
static bool hear(struct client *client, struct drives *drives)
{
    char text[4096];
    const ssize_t count = recv(client->socket, text, sizeof text, MSG_DONTWAIT);
    if (count < 0) {
        return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    }
    for (ssize_t i = 0; i < count; i++) {
        if (client->length + 1u >= LONGEST_WORD) {
            client->length = 0; /* no word of ours */
        }
        client->word[client->length++] = text[i];
        if (text[i] == '>') {
            client->word[client->length] = '\0';
            client->length = 0;
            if (!hear_word(client, drives)) {
                return false;
            }
        }
    }
    return count > 0;
}

/* Hear and speak until told to end (true), or until the bus is gone (false). */
static bool serve(struct client *client, struct drives *drives)
{
    struct drives_frame frames[VEHICLE_THRUSTERS];
    struct pollfd waits = {.fd = client->socket, .events = POLLIN, .revents = 0};
    const uint32_t began = awake();
    uint32_t last = began - TICK;
    while (!ends) {
        const uint32_t gone = awake() - last;
        if (poll(&waits, 1, gone >= TICK ? 0 : (int)((TICK - gone + 999u) / 1000u)) > 0
            && !hear(client, drives)) {
            return false;
        }
        const uint32_t now = awake();
        if (now - last < TICK) {
            continue;
        }
        last = now;
        if (client->answers < 3) {
            if (now - began > PATIENCE) {
                return false;
            }
            continue;
        }
        const size_t count = drives_tick(drives, now, frames);
        for (size_t i = 0; i < count; i++) {
            if (!say_frame(client, &frames[i])) {
                return false;
            }
        }
    }
    return true;
}

static int connected(const char *host, const char *port)
{
    const struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM};
    struct addrinfo *found = NULL;
    int opened = -1;
    if (getaddrinfo(host, port, &hints, &found) != 0) {
        return -1;
    }
    for (const struct addrinfo *each = found; each != NULL && opened < 0; each = each->ai_next) {
        opened = socket(each->ai_family, each->ai_socktype, each->ai_protocol);
        if (opened >= 0 && connect(opened, each->ai_addr, each->ai_addrlen) != 0) {
            (void)close(opened);
            opened = -1;
        }
    }
    freeaddrinfo(found);
    return opened;
}

/* Return a connection to the hub, which may be there soon; -1 if there is none. */
static int connected_soon(const char *host, const char *port)
{
    const struct timespec moment = {.tv_nsec = 100000000};
    const uint32_t began = microseconds();
    int opened = connected(host, port);
    while (opened < 0 && !ends && microseconds() - began < PATIENCE) {
        (void)nanosleep(&moment, NULL);
        opened = connected(host, port);
    }
    return opened;
}

int main(int count, char **words)
{
    if (count < 3 || count > 4 || (count == 4 && strlen(words[3]) > 32u)) {
        (void)fprintf(stderr, "usage: drives HOST PORT [CHANNEL]\n");
        return WRONG_WORDS;
    }
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = end;
    (void)sigaction(SIGTERM, &action, NULL);
    (void)sigaction(SIGINT, &action, NULL);
    struct client client = {.socket = -1, .channel = count == 4 ? words[3] : "can0"};
    client.socket = connected_soon(words[1], words[2]);
    if (client.socket < 0) {
        (void)fprintf(stderr, "drives: no hub at %s:%s\n", words[1], words[2]);
        return ends ? ENDED : BUS_GONE;
    }
    static struct drives drives;
    drives_begin(&drives);
    const bool served = serve(&client, &drives);
    drives_quiet(&drives);
    (void)close(client.socket);
    if (!served) {
        (void)fprintf(stderr, "drives: the bus at %s, port %s, is gone\n", words[1], words[2]);
    }
    return served ? ENDED : BUS_GONE;
}
