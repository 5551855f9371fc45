"""Fleet control of vehicles with VDA 5050 (version 2.0 and 2.1) over MQTT."""
