"""What robots run on, whatever drives their vehicles: slots, orders, policies, records, time."""
