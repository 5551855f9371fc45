// A virtual vehicle of vda-5050-lib: node virtual_vehicle.js '{"port": 1883, "serial": "agv-1", "x": 20, "y": 8}'
"use strict";
const { AgvController, VirtualAgvAdapter } = require("vda-5050-lib");

const given = JSON.parse(process.argv[2]);
const vehicle = new AgvController(
    { manufacturer: "Acme", serialNumber: given.serial },
    {
        interfaceName: "uagv",
        vdaVersion: "2.0.0",
        transport: {
            brokerUrl: `mqtt://127.0.0.1:${given.port}`,
            heartbeat: 2,
            reconnectPeriod: 300,
            username: given.user,
            password: given.password,
        },
    },
    { agvAdapterType: VirtualAgvAdapter, publishStateInterval: 500, publishVisualizationInterval: 250 },
    {
        vehicleSpeed: given.speed ?? 8,
        tickRate: 20,
        agvNormalDeviationThetaTolerance: 4,
        initialPosition: { mapId: "local", x: given.x, y: given.y, theta: 0, lastNodeId: "0" },
    },
);
vehicle.start().then(() => console.log("vehicle is there"));
