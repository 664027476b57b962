# drives: the drives on a hub (mmrs can hub), or on anything else that speaks socketcand.
# Included by the Makefile of a vehicle, which sets BUS, the folder of its codec, and SHARED, this folder.
CFLAGS ?= -O2
STRICT = -std=c11 -Wall -Wextra -Werror -Wconversion
FIRMWARE = bus.o vehicle.o drives.o outputs.o
VPATH = $(BUS):$(SHARED)

drives: hub.o $(FIRMWARE)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

%.o: %.c bus.h drives.h outputs.h vehicle.h
	$(CC) $(STRICT) -I. -I$(BUS) -I$(SHARED) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

clean:
	$(RM) drives *.o

.PHONY: clean
