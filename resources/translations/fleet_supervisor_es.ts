<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="es" sourcelanguage="en">
    <context>
        <name>FleetSupervisor</name>
        <message numerus="yes">
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>%n accounts</source>
            <translation>
                <numerusform>%n cuenta</numerusform>
                <numerusform>%n cuentas</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Add…</source>
            <translation>&amp;Añadir…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Name</source>
            <translation>&amp;Nombre</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Role</source>
            <translation>&amp;Rol</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Token holds</source>
            <translation>El &amp;testigo vale</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Accounts</source>
            <translation>Cuentas</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Accounts…</source>
            <translation>Cuentas…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Cancel</source>
            <translation>Cancelar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Change &amp;role…</source>
            <translation>Cambiar el &amp;rol…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Change role</source>
            <translation>Cambiar el rol</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Last connected</source>
            <translation>Última conexión</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Make account</source>
            <translation>Crear la cuenta</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Make token</source>
            <translation>Crear el testigo</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New &amp;token…</source>
            <translation>&amp;Testigo nuevo…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New account</source>
            <translation>Cuenta nueva</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New account {operator}</source>
            <translation>Cuenta nueva: {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New token for {operator}</source>
            <translation>Testigo nuevo para {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Operator</source>
            <translation>Operador</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Re&amp;fresh</source>
            <translation>Act&amp;ualizar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Re&amp;voke…</source>
            <translation>Re&amp;vocar…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke</source>
            <translation>Revocar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke the token of {operator}?</source>
            <translation>¿Revocar el testigo de {operator}?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke {operator}</source>
            <translation>Revocación de {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Role</source>
            <translation>Papel</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Role of {operator}</source>
            <translation>Rol de {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Since</source>
            <translation>Desde</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The gateway makes a token for the account. It is shown once, to be handed over.</source>
            <translation>La pasarela crea un testigo para la cuenta. Se muestra una sola vez, para entregarlo.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} ends at once, with every connection that it opened. The account stays, and a new token can be made for it. Robots go on with what they were told.</source>
            <translation>El testigo de {operator} se acaba enseguida, con todas las conexiones que abrió. La cuenta se queda, y se le puede crear un testigo nuevo. Los robots siguen con lo que se les dijo.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} is made.</source>
            <translation>Se ha hecho el testigo de {operator}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} is revoked.</source>
            <translation>Se ha revocado el testigo de {operator}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This gateway has no accounts yet: everybody on its computer may do everything. The first account ends that for good, and this connection too: connect again with its token. It has to be a supervisor's.</source>
            <translation>Esta pasarela aún no tiene cuentas: cualquiera en su ordenador puede hacerlo todo. La primera cuenta le pone fin para siempre, y también a esta conexión: conéctese otra vez con su testigo. Tiene que ser de un supervisor.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This gateway has no accounts: everybody on its computer may do everything. The first account, a supervisor's, ends that.</source>
            <translation>Esta pasarela no tiene cuentas: cualquiera en su ordenador puede hacerlo todo. La primera cuenta, de un supervisor, le pone fin.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: this desk is cut off and does not come back by itself.</source>
            <translation>Esta es su propia cuenta: esta consola queda desconectada y no vuelve por sí sola.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: this desk is cut off until you enter the new token.</source>
            <translation>Esta es su propia cuenta: esta consola queda desconectada hasta que introduzca el testigo nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: without being a supervisor you cannot undo it.</source>
            <translation>Esta es su propia cuenta: sin ser supervisor no podrá deshacerlo.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Token</source>
            <translation>Testigo</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Who may connect to the gateway and do what; takes a supervisor</source>
            <translation>Quién puede conectarse a la pasarela y qué puede hacer; hace falta un supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>connected now</source>
            <translation>conectado ahora</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>expired {time}</source>
            <translation>caducado: {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 1 day</source>
            <translation>durante 1 día</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 1 year</source>
            <translation>durante 1 año</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 30 days</source>
            <translation>durante 30 días</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 7 days</source>
            <translation>durante 7 días</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 90 days</source>
            <translation>durante 90 días</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>holds until {time}</source>
            <translation>válido hasta {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>none</source>
            <translation>ninguno</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>revoked {time}</source>
            <translation>revocado: {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>until it is revoked</source>
            <translation>hasta que se revoque</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} (you)</source>
            <translation>{operator} (usted)</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} gets a new token. The one before ends at once, with every connection that it opened.</source>
            <translation>{operator} recibe un testigo nuevo. El anterior se acaba enseguida, con todas las conexiones que abrió.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} is {role} now.</source>
            <translation>Ahora el rol de {operator} es {role}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} is {role}. Another role holds from the next thing on that is asked for, also over connections that are open.</source>
            <translation>El rol de {operator} es {role}. Otro rol vale a partir de la siguiente petición, también en conexiones abiertas.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source> s</source>
            <translation> s</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>%n robots were not removed: {why}</source>
            <translation>
                <numerusform>%n robot no se ha eliminado: {why}</numerusform>
                <numerusform>%n robots no se han eliminado: {why}</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>%n robots were removed: {names}</source>
            <translation>
                <numerusform>%n robot eliminado: {names}</numerusform>
                <numerusform>%n robots eliminados: {names}</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>%n sites</source>
            <translation>
                <numerusform>%n recinto</numerusform>
                <numerusform>%n recintos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Link</source>
            <translation>E&amp;nlace</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Paused</source>
            <translation>En &amp;pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Robots</source>
            <translation>&amp;Robots</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Serve this site…</source>
            <translation>&amp;Servir este recinto…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Speed</source>
            <translation>&amp;Velocidad</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Every robot is sent the map of {site} ({folder}), every desk shows it, and it is served until another one is chosen, also by a gateway that is started anew.</source>
            <translation>Cada robot recibe el mapa de {site} ({folder}), cada consola lo muestra, y se sirve hasta que se elija otro, también si la pasarela se vuelve a arrancar.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Folder</source>
            <translation>Carpeta</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>From the &amp;beginning again at its end</source>
            <translation>Vuelve a &amp;empezar al acabar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No link plays a recording at this gateway.</source>
            <translation>Ningún enlace de esta pasarela reproduce una grabación.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot is lost or offline.</source>
            <translation>Ningún robot está perdido ni fuera de línea.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot is stopped: commands and queues go on in the same metres, whatever roads and keepouts the new site has there. Stop robots first where that matters.</source>
            <translation>Ningún robot se detiene: las órdenes y las colas siguen en los mismos metros, sean cuales sean las vías y zonas prohibidas que el recinto nuevo tenga allí. Detenga antes los robots donde eso importe.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot was removed: {why}</source>
            <translation>No se ha eliminado ningún robot: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>None is stopped by that. One that comes back is told to abort what it still does, and is a new robot.</source>
            <translation>Eso no detiene a ninguno. Al que vuelva se le dice que aborte lo que aún haga, y es un robot nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Others cannot be chosen here.</source>
            <translation>Los demás no se pueden elegir aquí.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Pl&amp;ace</source>
            <translation>&amp;Lugar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recording of {link}</source>
            <translation>Grabación de {link}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings on the map</source>
            <translation>Grabaciones en el mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings that links play on the map: pause, speed, place</source>
            <translation>Grabaciones que los enlaces reproducen en el mapa: pausa, velocidad, lugar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings…</source>
            <translation>Grabaciones…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove</source>
            <translation>Quitar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove robots that are gone?</source>
            <translation>¿Eliminar los robots que ya no están?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove robots…</source>
            <translation>Eliminar robots…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove {names}</source>
            <translation>Eliminar {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Seconds after the beginning</source>
            <translation>Segundos desde el comienzo</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve this site</source>
            <translation>Servir este recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve {site}</source>
            <translation>Servir {site}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve {site}?</source>
            <translation>¿Servir {site}?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Site</source>
            <translation>Recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Sites</source>
            <translation>Recintos</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Site…</source>
            <translation>Recinto…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>State</source>
            <translation>Estado</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Take robots that are lost or offline off every desk; takes a supervisor</source>
            <translation>Quita de todas las consolas los robots perdidos o fuera de línea; requiere un supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>The desk is not connected to a gateway. Press Connect first.</source>
            <translation>La consola no está conectada a ninguna pasarela. Pulse antes Conectar.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>They go from every desk. What is in their queues is removed, what they were told and have not done has failed; what they did stays stored.</source>
            <translation>Desaparecen de todas las consolas. Lo que hay en sus colas se elimina, las órdenes que no han hecho fallan; lo que hicieron sigue guardado.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Version</source>
            <translation>Versión</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Which of the published sites the gateway serves; takes a supervisor</source>
            <translation>Cuál de los recintos publicados sirve la pasarela; hace falta un supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Which site is served</source>
            <translation>Qué recinto se sirve</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Why, for the log</source>
            <translation>Por qué, para el registro</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>all %n that are lost or offline</source>
            <translation>
                <numerusform>el único perdido o fuera de línea (%n)</numerusform>
                <numerusform>los %n perdidos o fuera de línea</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>can be chosen</source>
            <translation>se puede elegir</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>served now</source>
            <translation>se sirve ahora</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>the %n selected ones</source>
            <translation>
                <numerusform>el seleccionado (%n)</numerusform>
                <numerusform>los %n seleccionados</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>{file}: {place} s of {length} s</source>
            <translation>{file}: {place} s de {length} s</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>{site} is served now.</source>
            <translation>Ahora se sirve {site}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>Asking the gateway …</source>
            <translation>Preguntando a la pasarela …</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>This gateway says nothing of roles: it is older than accounts. Update it.</source>
            <translation>Esta pasarela no dice nada de roles: es anterior a las cuentas. Actualícela.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>This takes a supervisor, and {operator} is {role} here. If that was changed meanwhile, disconnect and connect again.</source>
            <translation>Para esto hace falta un supervisor, y aquí el rol de {operator} es {role}. Si mientras tanto se ha cambiado, desconéctese y conéctese otra vez.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>{words}: the gateway's answer cannot be read ({kind}). Update the gateway or the plugin, whichever is older.</source>
            <translation>{words}: la respuesta de la pasarela no se puede leer ({kind}). Actualice la pasarela o el complemento, lo que sea más antiguo.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>&amp;Copy</source>
            <translation>&amp;Copiar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>A phone whose camera reads this code opens the field page, signed in with the token:</source>
            <translation>Un teléfono que lee este código con la cámara abre la página de campo con la sesión iniciada con el token:</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Code for a phone</source>
            <translation>Código para un teléfono</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Copied. It stays in the clipboard until something else is copied.</source>
            <translation>Copiado. Se queda en el portapapeles hasta que se copie otra cosa.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>For a phone: connect this desk by the address that phones reach the gateway by, not by {host}, and a new token has a code here that opens the field page.</source>
            <translation>Para un teléfono: conecte esta consola por la dirección con la que los teléfonos llegan a la pasarela, no por {host}, y un token nuevo tendrá aquí un código que abre la página de campo.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>The Python package segno is missing, which draws the code for phones. Install the plugin from its release zip, which contains it.</source>
            <translation>Falta el paquete de Python segno, que dibuja el código para los teléfonos. Instale el complemento desde el zip de la versión publicada, que lo contiene.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>This desk was connected with what the token takes the place of, and is cut off. Enter the token in the Fleet panel under Access, then press Connect.</source>
            <translation>Esta consola estaba conectada con aquello que el testigo reemplaza, y queda desconectada. Introduzca el testigo en el panel de la flota, en Acceso, y pulse Conectar.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Token of {operator}</source>
            <translation>Testigo de {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>holds</source>
            <translation>válido</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>{operator}, {role}: the token {until}. It is shown now and never again, and kept nowhere: hand it over on a way that others do not read. If it gets lost, make a new one.</source>
            <translation>{operator}, {role}: testigo {until}. Se muestra ahora y nunca más, y no se guarda en ningún sitio: entréguelo por una vía que otros no lean. Si se pierde, cree uno nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Across the base of a cone; the cones touch the track's limits</source>
            <translation>Anchura de la base de un cono; los conos tocan los límites de la pista</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Braking lane</source>
            <translation>Carril de frenado</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the corridor</source>
            <translation>Anchura libre del corredor</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the gates</source>
            <translation>Anchura libre de las puertas</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the lane</source>
            <translation>Anchura libre del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the track</source>
            <translation>Anchura libre de la pista</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the ways in and out</source>
            <translation>Anchura libre de los caminos de entrada y salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones inside each inner circle</source>
            <translation>Conos dentro de cada círculo interior</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones on each side of each lane</source>
            <translation>Conos a cada lado de cada carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones outside each outer circle</source>
            <translation>Conos fuera de cada círculo exterior</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones that close the end of the lane</source>
            <translation>Conos que cierran el final del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones that close the way out</source>
            <translation>Conos que cierran el camino de salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones to go round</source>
            <translation>Conos que se rodean</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Constant-radius circle</source>
            <translation>Círculo de radio constante</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Corridor</source>
            <translation>Corredor</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Diameter of the inner circles</source>
            <translation>Diámetro de los círculos interiores</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Diameter of the outer circles</source>
            <translation>Diámetro de los círculos exteriores</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Double lane change</source>
            <translation>Doble cambio de carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student Rules, D 4.1</source>
            <translation>Reglamento de Formula Student, D 4.1</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student Rules, D 5.1</source>
            <translation>Reglamento de Formula Student, D 5.1</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student acceleration</source>
            <translation>Aceleración de Formula Student</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student skid pad</source>
            <translation>Skid pad de Formula Student</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From a gate to the nearest cone</source>
            <translation>De una puerta al cono más cercano</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From a line to the big cones before and behind it</source>
            <translation>De una línea a los conos grandes de antes y después</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From centre to centre of the circles</source>
            <translation>De centro a centro de los círculos</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone</source>
            <translation>De cono a cono</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the lane</source>
            <translation>De cono a cono a lo largo del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the middle of the lane</source>
            <translation>De cono a cono a lo largo del centro del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the track</source>
            <translation>De cono a cono a lo largo de la pista</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the ways in and out</source>
            <translation>De cono a cono a lo largo de los caminos de entrada y salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From pair to pair</source>
            <translation>De par a par</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the left limit of the entry lane to the right one of the side lane</source>
            <translation>Del límite izquierdo del carril de entrada al derecho del carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the meeting point to the first cones of the ways in and out</source>
            <translation>Del punto de encuentro a los primeros conos de los caminos de entrada y salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the middle of the path to these cones</source>
            <translation>Del centro del camino a estos conos</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the right limit of the entry lane to that of the side lane</source>
            <translation>Del límite derecho del carril de entrada al del carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the starting line to the finish line</source>
            <translation>De la línea de salida a la de meta</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the timing line to the big cones before and behind it</source>
            <translation>De la línea de cronometraje a los conos grandes de antes y después</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>ISO 4138:2021, method 1</source>
            <translation>ISO 4138:2021, método 1</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Lane before braking begins</source>
            <translation>Carril antes de empezar a frenar</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Lane to stop in behind the finish line</source>
            <translation>Carril de parada tras la línea de meta</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Least width of the exit lane</source>
            <translation>Anchura mínima del carril de salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the corridor</source>
            <translation>Longitud del corredor</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the way in that has cones</source>
            <translation>Longitud con conos del camino de entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the way out that has cones</source>
            <translation>Longitud con conos del camino de salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Obstacle avoidance</source>
            <translation>Evitación de obstáculos</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Part of each outer circle that has cones</source>
            <translation>Parte de cada círculo exterior que tiene conos</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Radius of the middle of the lane</source>
            <translation>Radio del centro del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 1: entry lane</source>
            <translation>Sección 1: carril de entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 2: way to the side lane</source>
            <translation>Sección 2: camino al carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 3: side lane</source>
            <translation>Sección 3: carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 4: way back</source>
            <translation>Sección 4: camino de vuelta</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 5: exit lane</source>
            <translation>Sección 5: carril de salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Sections 5 and 6: exit lane</source>
            <translation>Secciones 5 y 6: carril de salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Slalom</source>
            <translation>Eslalon</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Speed at which braking begins</source>
            <translation>Velocidad a la que empieza el frenado</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>To which side it goes first</source>
            <translation>Hacia qué lado va primero</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the entry lane</source>
            <translation>Anchuras de vehículo en la anchura del carril de entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the exit lane</source>
            <translation>Anchuras de vehículo en la anchura del carril de salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the side lane</source>
            <translation>Anchuras de vehículo en la anchura del carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to each of these widths</source>
            <translation>Lo que se añade a cada una de estas anchuras</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the entry lane</source>
            <translation>Lo que se añade a la anchura del carril de entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the exit lane</source>
            <translation>Lo que se añade a la anchura del carril de salida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the side lane</source>
            <translation>Lo que se añade a la anchura del carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What of the exit lane is in line with the entry lane</source>
            <translation>Qué del carril de salida está alineado con el de entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Which way it is driven</source>
            <translation>En qué sentido se recorre</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Width of the vehicle without mirrors</source>
            <translation>Anchura del vehículo sin espejos</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>collect them</source>
            <translation>recogerlos</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>done as early as possible</source>
            <translation>acabar lo antes posible</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>drive back</source>
            <translation>vuelven</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>drive to a store</source>
            <translation>van a un almacén</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>fewest metres</source>
            <translation>menos metros</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give a number</source>
            <translation>dé un número</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give a whole number</source>
            <translation>dé un número entero</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give one of {choices}</source>
            <translation>dé uno de {choices}</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give {least:g} or more</source>
            <translation>dé {least:g} o más</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>left</source>
            <translation>izquierda</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>left limit</source>
            <translation>límite izquierdo</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>length after UN R13-H; test after ISO 21994</source>
            <translation>longitud según UN R13-H; ensayo según ISO 21994</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>middle</source>
            <translation>centro</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>no standard: 18 m as European testers drive it</source>
            <translation>ninguna norma: 18 m, como la conducen los probadores europeos</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>no standard: colours, width and spacing of Formula Student</source>
            <translation>ninguna norma: colores, anchura y separación de Formula Student</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>place them</source>
            <translation>colocarlos</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>quick preview</source>
            <translation>vista previa rápida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>right</source>
            <translation>derecha</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>right limit</source>
            <translation>límite derecho</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>solved</source>
            <translation>resuelto</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>solved: nothing better than the preview was found</source>
            <translation>resuelto: no se encontró nada mejor que la vista previa</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>stay where they are</source>
            <translation>quedan donde están</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>the best that is installed</source>
            <translation>el mejor de los instalados</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>the preview: quick, not the best</source>
            <translation>la vista previa: rápida, no la mejor</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>to the left</source>
            <translation>a la izquierda</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>to the right</source>
            <translation>a la derecha</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is where a cone stands: {robot} put it down at {cone_x:.2f}, {cone_y:.2f}.</source>
            <translation>({x:.2f}, {y:.2f}) m es donde hay un cono: {robot} lo puso en {cone_x:.2f}, {cone_y:.2f}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is where {robot} stands.</source>
            <translation>({x:.2f}, {y:.2f}) m es donde está parado {robot}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is {away:.2f} m from {what} of {robot} at {other_x:.2f}, {other_y:.2f}: keep {clear_m:g} m between targets.</source>
            <translation>({x:.2f}, {y:.2f}) m está a {away:.2f} m de {what} de {robot} en {other_x:.2f}, {other_y:.2f}: deje {clear_m:g} m entre objetivos.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>No layer of the project says where obstacles and keepouts are, so nobody has looked. Open the site's project, or give layers their roles.</source>
            <translation>Ninguna capa del proyecto dice dónde hay obstáculos y zonas prohibidas, así que nadie lo ha mirado. Abra el proyecto del recinto o dé papeles a las capas.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} cannot be read, so what is in it was not looked at. Repair its source, or take its role away.</source>
            <translation>La capa {layer} no se puede leer, así que no se ha mirado qué hay en ella. Repare su origen o quítele el papel.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} has no CRS, so nobody knows where on the site it lies. Set it (Layer &gt; Set CRS of Layer), or take its role away.</source>
            <translation>La capa {layer} no tiene SRC, así que nadie sabe en qué lugar del recinto está. Defínalo (Capa &gt; Establecer SRC de la capa) o quítele el papel.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} has not answered for {seconds:g} s, so what is in it was not looked at. Bring its server or drive back and try again, or take the role of the layer away.</source>
            <translation>La capa {layer} no responde desde hace {seconds:g} s, así que no se ha mirado qué hay en ella. Restablezca su servidor o su unidad e inténtelo de nuevo, o quite el papel a la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The project has no CRS, so the map is taken to be in the site's, {crs}; a layer in another CRS lies at a wrong place on it. Choose the project's CRS at the bottom right in QGIS.</source>
            <translation>El proyecto no tiene SRC, así que se considera que el mapa está en el del recinto, {crs}; una capa en otro SRC aparece en un lugar equivocado. Elija el SRC del proyecto abajo a la derecha en QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>a task</source>
            <translation>una tarea</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>the end of the route</source>
            <translation>el final de la ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>the target</source>
            <translation>el objetivo</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot be sent to targets.</source>
            <translation>{robot} no se puede enviar a objetivos.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot be told where it starts.</source>
            <translation>A {robot} no se le puede decir dónde empieza.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot follow routes.</source>
            <translation>{robot} no puede seguir rutas.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is at work for {operator} ({task}): sending this takes its place.</source>
            <translation>{robot} trabaja para {operator} ({task}): al enviarlo lo sustituye.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is only seen: it takes no commands.</source>
            <translation>{robot} solo se ve: no acepta órdenes.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is {state}: it is told this when it is heard again, if that is soon enough.</source>
            <translation>{robot}: {state}; recibirá esto cuando se vuelva a saber de él, si es lo bastante pronto.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} places no cones.</source>
            <translation>{robot} no coloca conos.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} places no cones: it only drives there.</source>
            <translation>{robot} no coloca conos: solo va hasta allí.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{where} m is outside the site {name}, which reaches from ({x_min:g}, {y_min:g}) to ({x_max:g}, {y_max:g}) m. Click inside it.</source>
            <translation>{where} m está fuera del recinto {name}, que va de ({x_min:g}, {y_min:g}) a ({x_max:g}, {y_max:g}) m. Haga clic dentro.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>latitude, longitude</source>
            <translation>latitud, longitud</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>latitude, longitude, as in 48.2083, 16.3725</source>
            <translation>latitud, longitud, como 48.2083, 16.3725</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>x, y</source>
            <translation>x, y</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>x, y, as in 488070.50, 5190055.20</source>
            <translation>x, y, como 488070.50, 5190055.20</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{shown!r} is no place: write {right}.</source>
            <translation>{shown!r} no es ningún lugar: escriba {right}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r} is not on the site {name}; with its two numbers swapped it is. Write {order}: {first:.10g}, {second:.10g}.</source>
            <translation>{text!r} no está en el recinto {name}; con los dos números intercambiados, sí. Escriba {order}: {first:.10g}, {second:.10g}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r} is {away:.0f} km outside the site {name}. Write {order}, and check the numbers and the CRS that they are in ({crs}).</source>
            <translation>{text!r} está {away:.0f} km fuera del recinto {name}. Escriba {order}, y compruebe los números y su SRC ({crs}).</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r}: latitude {lat:g} and longitude {lon:g} are not on the earth; write latitude first, or choose the CRS that the numbers are in.</source>
            <translation>{text!r}: la latitud {lat:g} y la longitud {lon:g} no están en la Tierra; escriba antes la latitud, o elija el SRC en que están los números.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>Abort of {robot}</source>
            <translation>Abortar {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>No robot is selected, so none was aborted. Select it in the table or on the map.</source>
            <translation>No hay ningún robot seleccionado, así que no se abortó ninguno. Selecciónelo en la tabla o en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>Pause of {robot}</source>
            <translation>Pausa de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>The operator's name is empty. Write who you are: it stands in every log.</source>
            <translation>El nombre del operador está vacío. Escriba quién es: está en todos los registros.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>This gateway serves another site than the rest of the fleet: {reason}.</source>
            <translation>Esta pasarela sirve otro recinto que el resto de la flota: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>{words} was not sent: another site is served now. Draw it anew.</source>
            <translation>{words}: no se envió, porque ahora se sirve otro recinto. Dibújelo de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>{words} was not sent: robot {robot} was removed.</source>
            <translation>{words}: no se envió, porque se eliminó el robot {robot}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>({x:.2f}, {y:.2f}) m</source>
            <translation>({x:.2f}, {y:.2f}) m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The layer {layer} cannot be placed on the site ({error}), so obstacles in it are not seen. Correct its CRS, or take its role away.</source>
            <translation>La capa {layer} no se puede situar en el recinto ({error}), así que sus obstáculos no se ven. Corrija su SRC, o quítele el papel.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The route</source>
            <translation>La ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The way to {to}</source>
            <translation>El camino hasta {to}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The way to {to} leaves the road surface.</source>
            <translation>El camino hasta {to} se sale de la superficie de vía.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>is on</source>
            <translation>está sobre</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>is {away:.2f} m from</source>
            <translation>está a {away:.2f} m de</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{layer} (feature {id})</source>
            <translation>{layer} (objeto {id})</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{leave} of {legs} legs leave the road surface.</source>
            <translation>{leave} de {legs} tramos se salen de la superficie de vía.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{off} of {points} points are not on a road surface.</source>
            <translation>{off} de {points} puntos están fuera de las superficies de vía.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{place} is not on a road surface.</source>
            <translation>{place} está fuera de las superficies de vía.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{spot} enters the keepout {name}. Choose a place or way outside it.</source>
            <translation>{spot} entra en la zona prohibida {name}. Elija un lugar o recorrido fuera.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{spot} {where} {name}. Choose a place or way beside it.</source>
            <translation>{spot} {where} {name}. Elija un lugar o recorrido al lado.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link} is down: {reason}.</source>
            <translation>El enlace {link} está caído: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link} is down: {reason}. Nothing reaches {robots}.</source>
            <translation>El enlace {link} está caído: {reason}. Nada llega a {robots}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link}: {reason}.</source>
            <translation>Enlace {link}: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>The database account of robot {robot} is locked until {time}: its program kept all others waiting. Nothing but a stop reaches it: Abort unlocks the account. Have the program mended.</source>
            <translation>La cuenta de base de datos del robot {robot} está bloqueada hasta las {time}: su programa hacía esperar a todos los demás. Solo le llega una parada: Abortar desbloquea la cuenta. Haga arreglar el programa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>The program of robot {robot} keeps all others waiting at the database, and its account cannot be locked. Have an administrator run: robot-bridge database upgrade</source>
            <translation>El programa del robot {robot} hace esperar a todos los demás en la base de datos, y su cuenta no se puede bloquear. Que un administrador ejecute: robot-bridge database upgrade</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>{names} and {count} more</source>
            <translation>{names} y {count} más</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/control/pending_command.py" />
            <source>%n cones for {robot}</source>
            <translation>
                <numerusform>%n cono para {robot}</numerusform>
                <numerusform>%n conos para {robot}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>, theta {degrees:.0f}°</source>
            <translation>, theta {degrees:.0f}°</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>; along the roads {note}</source>
            <translation>; por las vías {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>; straight</source>
            <translation>; recto</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>; the way there is being found</source>
            <translation>; se está buscando el camino hasta allí</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>A part of this route follows the roads, and the way back may be another: it is not turned round. Draw it from the other end with Route on roads.</source>
            <translation>Una parte de esta ruta sigue las vías, y la vuelta puede ser otra: no se invierte. Dibújela desde el otro extremo con Ruta por vías.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>A start position is no task: Send tells the robot at once.</source>
            <translation>Una posición inicial no es una tarea: Enviar se lo dice al robot al instante.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>And {more} more.</source>
            <translation>Y {more} más.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Cone for {robot} at {place}</source>
            <translation>Cono para {robot} en {place}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Route for {robot}: {points} points, {length:.1f} m{along_roads}</source>
            <translation>Ruta para {robot}: {points} puntos, {length:.1f} m{along_roads}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Start position of {robot} at {place}{turned}</source>
            <translation>Posición inicial de {robot} en {place}{turned}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>This part of the route follows the roads and is not changed by hand. Take it back with Backspace, or draw this part with Draw route.</source>
            <translation>Esta parte de la ruta sigue las vías y no se cambia a mano. Quítela con Retroceso, o dibuje esta parte con Dibujar ruta.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>a route needs at least two points: click the next one</source>
            <translation>una ruta necesita al menos dos puntos: haga clic en el siguiente</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>it has not been checked to its end</source>
            <translation>todavía no se ha terminado de comprobar</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>the way there is not known yet</source>
            <translation>todavía no se sabe el camino hasta allí</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>{x:.2f}, {y:.2f} m</source>
            <translation>{x:.2f}, {y:.2f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>ABORT ALL</source>
            <translation>ABORTAR TODO</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Clear emergency stop</source>
            <translation>Levantar la parada de emergencia</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Closing the road at {x:.1f}, {y:.1f} m</source>
            <translation>Cierre de la vía en {x:.1f}, {y:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>EMERGENCY STOP</source>
            <translation>PARADA DE EMERGENCIA</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>EMERGENCY STOP is NOT sent yet: the link is down. It is sent as soon as that is back; use the robots' own emergency stops now.</source>
            <translation>La PARADA DE EMERGENCIA aún NO se ha enviado: el enlace está caído. Se envía en cuanto vuelva; use ahora las paradas de emergencia de los propios robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Opening the road</source>
            <translation>Apertura de la vía</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>The Abort is NOT sent yet: the link is down. It is sent if that is back within {seconds:g} s; use the robots' own emergency stops now.</source>
            <translation>La orden de abortar aún NO se ha enviado: el enlace está caído. Se envía si vuelve antes de {seconds:g} s; use ahora las paradas de emergencia de los propios robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>the desk is not connected to a gateway. Connect first; to stop a robot now use the robot's own emergency stop.</source>
            <translation>la consola no está conectada a ninguna pasarela. Conéctese antes; para detener ahora un robot use su propia parada de emergencia.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>this window, or the computer, stood still for {seconds:.0f} s, and what was clicked meanwhile may be old. Look at the robots, then ask again.</source>
            <translation>esta ventana, o el ordenador, estuvo parada {seconds:.0f} s, y lo que se pulsó entretanto puede ser antiguo. Mire los robots y vuelva a pedirlo.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{draft} was not sent: {fault}</source>
            <translation>{draft}: no se envió: {fault}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{draft} were not sent: several targets are driven to one after the other. Press Add to queue.</source>
            <translation>{draft}: no se envió: a varios objetivos se va uno tras otro. Pulse Añadir a la cola.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{robot} gives way to {other}</source>
            <translation>{robot} cede el paso a {other}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words} was NOT sent: {error}</source>
            <translation>{words}: NO se envió: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: done</source>
            <translation>{words}: hecho</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: sent to %n robots</source>
            <translation>
                <numerusform>{words}: enviado a %n robot</numerusform>
                <numerusform>{words}: enviado a %n robots</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated if the link is back within {limit:g} s, unless robots are asked to stop meanwhile; it is never done twice.</source>
            <translation>{words}: la pasarela no ha respondido en {seconds:g} s, así que quizá no haya llegado. Se repite si el enlace vuelve en {limit:g} s, salvo que entretanto se pida parar robots; nunca se hace dos veces.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated if the link is back within {limit:g} s; it is never done twice.</source>
            <translation>{words}: la pasarela no ha respondido en {seconds:g} s, así que quizá no haya llegado. Se repite si el enlace vuelve en {limit:g} s; nunca se hace dos veces.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated when the link is back; it is never done twice.</source>
            <translation>{words}: la pasarela no ha respondido desde hace {seconds:g} s, así que quizá no haya llegado. Se repite cuando vuelve el enlace; nunca se hace dos veces.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>The gateway has not answered for {seconds:g} s which way leads to where you clicked, so the route does not go there. Click there again.</source>
            <translation>La pasarela no ha respondido desde hace {seconds:g} s qué camino lleva adonde hizo clic, así que la ruta no va allí. Vuelva a hacer clic allí.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>corners tighter than the robot turns: {tight}</source>
            <translation>esquinas más cerradas que el giro del robot: {tight}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>off the roads of other robots</source>
            <translation>fuera de las vías de otros robots</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>only on {surfaces}</source>
            <translation>solo por {surfaces}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>roads at least {metres:g} m wide</source>
            <translation>vías de al menos {metres:g} m de ancho</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>surface not known</source>
            <translation>superficie desconocida</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>the fastest way</source>
            <translation>el camino más rápido</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>the gateway's answer holds no way; it may be older than this plugin</source>
            <translation>la respuesta de la pasarela no trae ningún recorrido; puede ser más antigua que este complemento</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>{metres:.0f} m {surface}</source>
            <translation>{metres:.0f} m {surface}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>{metres:.1f} m</source>
            <translation>{metres:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>{minutes} min {seconds} s</source>
            <translation>{minutes} min {seconds} s</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>{seconds} s</source>
            <translation>{seconds} s</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>There is nothing to send. Select a robot, then set a cone target or draw a route on the map.</source>
            <translation>No hay nada que enviar. Seleccione un robot, y ponga un objetivo de cono o dibuje una ruta en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent, since only now this is known: {warnings} Ask for it again to send it all the same.</source>
            <translation>{in_words}: no se envió, porque hasta ahora no se sabía esto: {warnings} Pídalo otra vez para enviarlo de todos modos.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: robots were told to stop before it had been checked.</source>
            <translation>{in_words}: no se envió, porque se ordenó detener los robots antes de terminar la comprobación.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: the draft was changed before it had been checked. Send it anew.</source>
            <translation>{in_words}: no se envió, porque el borrador cambió antes de terminar la comprobación. Envíelo de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: {error}</source>
            <translation>{in_words} no se envió: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: {robot} has moved since its way was found. It is found again from where the robot is now; send it when it is drawn.</source>
            <translation>{in_words} no se ha enviado: {robot} se ha movido desde que se encontró su camino. Se vuelve a buscar desde donde está ahora el robot; envíelo cuando esté dibujado.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>It is not known where {robot} is, so nobody has looked at the way that it drives.</source>
            <translation>No se sabe dónde está {robot}, así que nadie ha comprobado el camino que recorre.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>No way along the roads leads there: {why}.</source>
            <translation>Ningún camino por las vías lleva allí: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>The gateway does not answer which way leads there. Set the target again when the link is there.</source>
            <translation>La pasarela no responde qué camino lleva allí. Vuelva a poner el objetivo cuando haya conexión.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>{robot} has not declared that it asks for its path or takes cones with one: sent now it drives straight. Add to queue, with a route around what is in its way, where that is not wanted.</source>
            <translation>{robot} no ha declarado que pida su camino ni que acepte conos con un camino: enviado ahora, va recto. Donde eso no convenga, añádalo a la cola con una ruta que evite lo que hay en medio.</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function distance_to_robot&lt;/h3&gt; &lt;p&gt;Returns how far a robot is from a feature or a geometry, in metres of the site.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;distance_to_robot(robot, [geometry], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;geometry&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional; without it, that of the feature that is looked at&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the CRS of the geometry, such as 'EPSG:4326'; without it, that of the layer whose feature is looked at, else that of the project&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1')&lt;/code&gt; &amp;rarr; 12.3&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1', make_point(16.8438, 46.8804), 'EPSG:4326')&lt;/code&gt; &amp;rarr; 104.6&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1') &amp;lt; 5&lt;/code&gt; &amp;rarr; true of features near the robot&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;The distance is measured in the plane of the site's CRS; in a polygon it is 0. NULL stands for a robot whose place is not known, and while this QGIS is connected to no gateway. Places are at most half a second old; a layer shows them when it is drawn.&lt;/p&gt;</source>
            <translation>&lt;h3&gt;función distance_to_robot&lt;/h3&gt; &lt;p&gt;Devuelve a qué distancia está un robot de un objeto espacial o de una geometría, en metros del recinto.&lt;/p&gt; &lt;h4&gt;Sintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;distance_to_robot(robot, [geometry], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentos&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;su nombre, como en el panel Flota&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;geometry&lt;/i&gt;&lt;/td&gt;&lt;td&gt;opcional; sin ella, la del objeto espacial que se mira&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;opcional, el SRC de la geometría, como 'EPSG:4326'; sin él, el de la capa cuyo objeto espacial se mira, o si no el del proyecto&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Ejemplos&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1')&lt;/code&gt; &amp;rarr; 12.3&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1', make_point(16.8438, 46.8804), 'EPSG:4326')&lt;/code&gt; &amp;rarr; 104.6&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1') &amp;lt; 5&lt;/code&gt; &amp;rarr; verdadero para los objetos espaciales cerca del robot&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notas&lt;/h4&gt; &lt;p&gt;La distancia se mide en el plano del SRC del recinto; dentro de un polígono es 0. NULL si no se sabe dónde está el robot, y mientras este QGIS no está conectado a ninguna pasarela. Los lugares tienen como máximo medio segundo; una capa los muestra cuando se dibuja.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function road_surface&lt;/h3&gt; &lt;p&gt;Returns the class of the road surface at a place, such as 'asphalt', or NULL where there is none.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;road_surface(x, y, [layer], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;x, y&lt;/i&gt;&lt;/td&gt;&lt;td&gt;the place; x is the easting or the longitude, whatever the CRS&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;layer&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the name or id of a layer of areas; without it, all layers of the project with the role road surface&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the CRS of the place, such as 'EPSG:4326'; without it, that of the layer whose feature is looked at, else that of the project&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y)&lt;/code&gt; &amp;rarr; 'asphalt'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface(16.8438, 46.8804, crs:='EPSG:4326')&lt;/code&gt; &amp;rarr; 'slippery'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y, 'Road surfaces') IS NULL&lt;/code&gt; &amp;rarr; true off the road&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;A place on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a generated one, then the smaller before the larger.&lt;/p&gt;</source>
            <translation>&lt;h3&gt;función road_surface&lt;/h3&gt; &lt;p&gt;Devuelve la clase de la superficie de vía en un lugar, como 'asphalt', o NULL donde no hay ninguna.&lt;/p&gt; &lt;h4&gt;Sintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;road_surface(x, y, [layer], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentos&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;x, y&lt;/i&gt;&lt;/td&gt;&lt;td&gt;el lugar; x es el este o la longitud, sea cual sea el SRC&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;layer&lt;/i&gt;&lt;/td&gt;&lt;td&gt;opcional, el nombre o el identificador de una capa de áreas; sin ella, todas las capas del proyecto con el papel de superficie de vía&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;opcional, el SRC del lugar, como 'EPSG:4326'; sin él, el de la capa cuyo objeto espacial se mira, o si no el del proyecto&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Ejemplos&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y)&lt;/code&gt; &amp;rarr; 'asphalt'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface(16.8438, 46.8804, crs:='EPSG:4326')&lt;/code&gt; &amp;rarr; 'slippery'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y, 'Road surfaces') IS NULL&lt;/code&gt; &amp;rarr; verdadero fuera de la vía&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notas&lt;/h4&gt; &lt;p&gt;Un lugar en el borde está en la superficie. Donde las superficies se superponen cuenta antes una dibujada que una generada, y después la menor antes que la mayor.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_age&lt;/h3&gt; &lt;p&gt;Returns the seconds since a robot's last message, by this computer's clock.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_age(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_age('r1')&lt;/code&gt; &amp;rarr; 0.4&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_age('r1') &amp;gt; 10&lt;/code&gt; &amp;rarr; true once it has been silent for more than 10 seconds&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;función robot_age&lt;/h3&gt; &lt;p&gt;Devuelve los segundos desde el último mensaje de un robot, según el reloj de este ordenador.&lt;/p&gt; &lt;h4&gt;Sintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_age(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentos&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;su nombre, como en el panel Flota&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Ejemplos&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_age('r1')&lt;/code&gt; &amp;rarr; 0.4&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_age('r1') &amp;gt; 10&lt;/code&gt; &amp;rarr; verdadero cuando lleva más de 10 segundos callado&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_battery&lt;/h3&gt; &lt;p&gt;Returns how full a robot's battery is, 0 to 1.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_battery(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_battery('r1')&lt;/code&gt; &amp;rarr; 0.82&lt;/li&gt; &lt;li&gt;&lt;code&gt;round(100 * robot_battery('r1')) || ' %'&lt;/code&gt; &amp;rarr; '82 %'&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;función robot_battery&lt;/h3&gt; &lt;p&gt;Devuelve lo llena que está la batería de un robot, de 0 a 1.&lt;/p&gt; &lt;h4&gt;Sintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_battery(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentos&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;su nombre, como en el panel Flota&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Ejemplos&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_battery('r1')&lt;/code&gt; &amp;rarr; 0.82&lt;/li&gt; &lt;li&gt;&lt;code&gt;round(100 * robot_battery('r1')) || ' %'&lt;/code&gt; &amp;rarr; '82 %'&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_state&lt;/h3&gt; &lt;p&gt;Returns how far what is known of a robot can be trusted: 'fresh', 'stale', 'lost' or 'offline'.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_state(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_state('r1')&lt;/code&gt; &amp;rarr; 'fresh'&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_state("robot") IN ('stale', 'lost')&lt;/code&gt; &amp;rarr; true of robots that are silent&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;función robot_state&lt;/h3&gt; &lt;p&gt;Devuelve hasta qué punto se puede confiar en lo que se sabe de un robot: 'fresh' (actual), 'stale' (desactualizado), 'lost' (perdido) u 'offline' (fuera de línea).&lt;/p&gt; &lt;h4&gt;Sintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_state(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentos&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;su nombre, como en el panel Flota&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Ejemplos&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_state('r1')&lt;/code&gt; &amp;rarr; 'fresh'&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_state("robot") IN ('stale', 'lost')&lt;/code&gt; &amp;rarr; verdadero para los robots que callan&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;NULL stands for a robot that the gateway has not told of, and while this QGIS is connected to none. What is not known of a robot is NULL as well. Values are at most half a second old; a layer shows them when it is drawn.&lt;/p&gt;</source>
            <translation>&lt;h4&gt;Notas&lt;/h4&gt; &lt;p&gt;NULL si la pasarela no ha hablado del robot, y mientras este QGIS no está conectado a ninguna. Lo que no se sabe de un robot también es NULL. Los valores tienen como máximo medio segundo; una capa los muestra cuando se dibuja.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;p&gt;Of more than 5 000 robots QGIS is told of those on the map. Another one is asked for when an expression names it, and for a minute from then on, up to 200 of them: about a second later it has its value, NULL until then.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Con más de 5 000 robots, QGIS recibe datos de los que están en el mapa. Otro se pide cuando una expresión lo nombra, y durante un minuto desde entonces, hasta 200: aproximadamente un segundo después tiene su valor; hasta entonces, NULL.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>Fleet</source>
            <translation>Flota</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>crs {given!r} is no CRS that QGIS knows; write a code such as 'EPSG:32633'</source>
            <translation>crs {given!r} no es un SRC que QGIS conozca; escriba un código como 'EPSG:32633'</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>no layer of the project has the role {role}; set it in Plugins &gt; Fleet Supervisor &gt; Layer roles, or name a layer as the third argument</source>
            <translation>ninguna capa del proyecto tiene el papel {role}; póngalo en Complementos &gt; Fleet Supervisor &gt; Papeles de las capas, o nombre una capa como tercer argumento</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>no vector layer of the project has the name or id {layer!r}</source>
            <translation>ninguna capa vectorial del proyecto tiene el nombre o el identificador {layer!r}</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: the geometry has no place in {crs}</source>
            <translation>{function}: la geometría no tiene lugar en {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: x is {x!r} and y is {y!r}; give two numbers</source>
            <translation>{function}: x es {x!r} e y es {y!r}; dé dos números</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: {geometry!r} is no geometry; give one, or a feature that has one</source>
            <translation>{function}: {geometry!r} no es una geometría; dé una, o un objeto espacial que la tenga</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>abort</source>
            <translation>aborto</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>cone at {x}, {y}</source>
            <translation>cono en {x}, {y}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>done</source>
            <translation>hecho</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>route of {number} points</source>
            <translation>ruta de {number} puntos</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>target at {x}, {y}</source>
            <translation>objetivo en {x}, {y}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>A stop would wait for the rest of a large request on the slow line to {url}: the link is opened again, and the stop sent first.</source>
            <translation>Una parada tendría que esperar al resto de una petición grande en la línea lenta hacia {url}: la conexión se abre de nuevo, y la parada se envía primero.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The CA file {file} has not answered for {seconds:g} s, so there is no link to {url} yet: the drive that it is on may be away. The desk waits for it. If it stays away, press Disconnect and choose a copy of the file on this computer.</source>
            <translation>El archivo de CA {file} no responde desde hace {seconds:g} s, así que aún no hay enlace con {url}: puede que la unidad en la que está no esté disponible. La consola la espera. Si no vuelve, pulse Desconectar y elija una copia del archivo en este ordenador.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The connection stopped on an internal fault ({name}: {error}). Press Connect to try again and report this text.</source>
            <translation>La conexión se detuvo por un error interno ({name}: {error}). Pulse Conectar para volver a intentarlo y comunique este texto.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The gateway at {url} closed the link. It is tried again.</source>
            <translation>La pasarela en {url} cerró el enlace. Se vuelve a intentar.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>This computer slept, or did nothing, for {seconds:.0f} s: what waits for it is old. The link is opened anew.</source>
            <translation>Este ordenador durmió, o no hizo nada, durante {seconds:.0f} s: lo que le espera es antiguo. La conexión se abre de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>What answers at {url} opens a WebSocket but did not answer the desk's greeting within {answer_within:g} s. Check that the URL leads to a Fleet Supervisor gateway.</source>
            <translation>Lo que responde en {url} abre un WebSocket pero no contestó al saludo de la consola en {answer_within:g} s. Compruebe que la URL lleva a una pasarela de Fleet Supervisor.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>at {gateway}; {given} did not answer</source>
            <translation>en {gateway}; {given} no respondió</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>at {gateway}; {given} refuses this desk</source>
            <translation>en {gateway}; {given} rechaza esta consola</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>No secure link to {place}: {reason}. If the gateway has no TLS, write ws:// instead of wss://.</source>
            <translation>No hay enlace seguro con {place}: {reason}. Si la pasarela no tiene TLS, escriba ws:// en lugar de wss://.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Nothing listens at {place}. Start the gateway (robot-bridge serve --site ...) or correct the URL.</source>
            <translation>Nada escucha en {place}. Arranque la pasarela (robot-bridge serve --site ...) o corrija la URL.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Over {url} everybody on the way could read the token. Write wss:// instead of ws://; a gateway that other computers can reach has TLS.</source>
            <translation>Por {url} cualquiera en el camino podría leer el testigo. Escriba wss:// en lugar de ws://; una pasarela accesible desde otros ordenadores tiene TLS.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The CA file {file} cannot be used: {reason}. Choose the ca.pem that whoever runs the site gave you.</source>
            <translation>El archivo de CA {file} no se puede usar: {reason}. Elija el ca.pem que le dio quien lleva el recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} cannot be trusted: {reason}.</source>
            <translation>No se puede confiar en el certificado de {place}: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} has expired. Whoever runs the site renews it with 'robot-bridge tls renew'; if it was renewed, check this computer's clock.</source>
            <translation>El certificado de {place} ha caducado. Quien lleva el recinto lo renueva con 'robot-bridge tls renew'; si ya se renovó, compruebe el reloj de este ordenador.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} holds only later: check this computer's clock.</source>
            <translation>El certificado de {place} solo vale más tarde: compruebe el reloj de este ordenador.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} is for another name: {reason} Use the name that the gateway's certificate was made for, or have one made for this name.</source>
            <translation>El certificado de {place} es para otro nombre: {reason} Use el nombre para el que se hizo el certificado de la pasarela, o haga hacer uno para este nombre.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} is from an authority that this desk does not trust. Choose the site's ca.pem as CA file under Access; whoever runs the site has it.</source>
            <translation>El certificado de {place} es de una autoridad en la que esta consola no confía. Elija el ca.pem del recinto como archivo de CA en Acceso; lo tiene quien lleva el recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} closed the link (code {code}{why}). It is tried again by itself.</source>
            <translation>La pasarela en {place} cerró el enlace (código {code}{why}). Se vuelve a intentar solo.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} ended the link{why}. Ask whoever runs the site for a new token and enter it under Access.</source>
            <translation>La pasarela en {place} terminó el enlace{why}. Pida un testigo nuevo a quien lleva el recinto e introdúzcalo en Acceso.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} ended your session{why}. Connect brings it back.</source>
            <translation>La pasarela en {place} terminó su sesión{why}. Conectar la recupera.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL is empty. {example}</source>
            <translation>La URL de la pasarela está vacía. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} begins with {scheme}; a gateway is reached over ws:// (or wss:// with TLS). {example}</source>
            <translation>La URL de la pasarela {url} empieza por {scheme}; se llega a ella por ws:// (o wss:// con TLS). {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} cannot be read: {error}. {example}</source>
            <translation>La URL de la pasarela {url} no se puede leer: {error}. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} cannot be used. Write it like {default_url}.</source>
            <translation>La URL de la pasarela {url} no se puede usar. Escríbala como {default_url}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} has port 0, where nothing can listen. {example}</source>
            <translation>La URL de la pasarela {url} tiene el puerto 0, donde nada puede escuchar. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} names no host. {example}</source>
            <translation>La URL de la pasarela {url} no nombra ningún servidor. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The host of {place} is not known to this network. Correct the URL.</source>
            <translation>Esta red no conoce el servidor de {place}. Corrija la URL.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The link to the gateway at {place} broke off. It is tried again by itself; if it does not come back, check the gateway and the network.</source>
            <translation>El enlace con la pasarela en {place} se rompió. Se vuelve a intentar solo; si no vuelve, compruebe la pasarela y la red.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The token cannot be right: it is one word. Paste it again, whole and alone.</source>
            <translation>El testigo no puede ser correcto: es una sola palabra. Péguelo otra vez, entero y solo.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>There is no desk at {url} (HTTP 404). A gateway's desk has the path /desk, as in {default_url}; or another program answers there.</source>
            <translation>No hay ninguna consola en {url} (HTTP 404). La de una pasarela tiene la ruta /desk, como en {default_url}; o allí responde otro programa.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>What answers at {place} does not speak WebSocket. Check host and port, and ws:// or wss://: a gateway prints its URL when it starts.</source>
            <translation>Lo que responde en {place} no habla WebSocket. Compruebe servidor y puerto, y ws:// o wss://: una pasarela escribe su URL al arrancar.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>What answers at {url} sent something that is not the desk's protocol: {text} ({kind}: {error}). Check that the URL leads to a Fleet Supervisor gateway of this version.</source>
            <translation>Lo que responde en {url} envió algo que no es el protocolo de la consola: {text} ({kind}: {error}). Compruebe que la URL lleva a una pasarela de Fleet Supervisor de esta versión.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Write it like {default_url}.</source>
            <translation>Escríbala como {default_url}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>it wants a token.</source>
            <translation>quiere un testigo.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>no reason given.</source>
            <translation>sin dar motivo.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>no scheme</source>
            <translation>ningún esquema</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>operator</source>
            <translation>operador</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>supervisor</source>
            <translation>supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>viewer</source>
            <translation>observador</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{place} broke off while the secure link was made. If the gateway has no TLS, write ws:// instead of wss://.</source>
            <translation>{place} cortó mientras se hacía el enlace seguro. Si la pasarela no tiene TLS, escriba ws:// en lugar de wss://.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{place} cannot be reached: {reason}. Check network and URL.</source>
            <translation>No se llega a {place}: {reason}. Compruebe la red y la URL.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{place} did not answer in time. Check that the gateway runs, and the network and firewall.</source>
            <translation>{place} no respondió a tiempo. Compruebe que la pasarela funciona, la red y el cortafuegos.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} answered HTTP {status} instead of opening a WebSocket. Check that a gateway runs there and what its log says.</source>
            <translation>{url} respondió HTTP {status} en lugar de abrir un WebSocket. Compruebe que allí funciona una pasarela y qué dice su registro.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} is where robots connect; operators connect to {desk}. Write that instead.</source>
            <translation>{url} es donde se conectan los robots; los operadores se conectan a {desk}. Escriba eso.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} refuses this desk: {said}</source>
            <translation>{url} rechaza esta consola: {said}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} refuses this desk: {said} Enter the operator's token under Access.</source>
            <translation>{url} rechaza esta consola: {said} Introduzca el testigo del operador en Acceso.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} takes no desk now: {said} It is tried again by itself.</source>
            <translation>{url} no admite ahora ninguna consola: {said} Se vuelve a intentar solo.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/fleet_state.py" />
            <source>Another site is served now: {site}, no longer {before}. Open its project.</source>
            <translation>Ahora se sirve otro recinto: {site}, ya no {before}. Abra su proyecto.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/fleet_state.py" />
            <source>The gateway has another database than before: its robots and commands are others, and those of before are not shown any more.</source>
            <translation>La pasarela tiene otra base de datos que antes: sus robots y órdenes son otros, y los de antes ya no se muestran.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>Another site, or another fleet, is served now than when this was asked for, and the same numbers are other places there: it was not sent to it. Look at the map, and ask for it again if it is still needed.</source>
            <translation>Ahora se sirve otro recinto, u otra flota, que cuando se pidió esto, y los mismos números son allí otros lugares: no se envió allí. Mire el mapa y vuelva a pedirlo si aún hace falta.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>It was sent before on a link that was lost, and may have been done then: look before you ask again.</source>
            <translation>Ya se envió por un enlace que se perdió, y puede haberse hecho entonces: mírelo antes de volver a pedirlo.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>No operator can connect at {url}: what answers there knows no desk, as the address of robots does not. A gateway's desk has the path /desk, as in {default_url}. Correct the URL, then press Connect.</source>
            <translation>Ningún operador puede conectarse a {url}: lo que responde allí no conoce ninguna consola, como tampoco la dirección de los robots. La consola de una pasarela tiene la ruta /desk, como en {default_url}. Corrija la URL y pulse Conectar.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} refused a message: {error}</source>
            <translation>La pasarela en {url} rechazó un mensaje: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} sends no positions: {error}</source>
            <translation>La pasarela en {url} no envía posiciones: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} serves another fleet than the gateway that named it. Connect to it yourself if that is what you want.</source>
            <translation>La pasarela de {url} sirve otra flota que la pasarela que la nombró. Conéctese a ella directamente si es lo que quiere.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} speaks protocol {theirs}, this plugin protocol {ours}. Update whichever of the two is older, then press Connect.</source>
            <translation>La pasarela en {url} habla el protocolo {theirs}, este complemento el protocolo {ours}. Actualice el más antiguo de los dos y pulse Conectar.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} turned the desk away: {error}</source>
            <translation>La pasarela en {url} rechazó la consola: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was closed before the gateway answered: whether it arrived is not known. Connect again and look in the command log.</source>
            <translation>El enlace se cerró antes de que la pasarela respondiera: no se sabe si llegó. Vuelva a conectar y mire el registro de órdenes.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and it was not sent again: robots were asked to stop after it. If it had arrived before, the command log shows it, and the stop ends it.</source>
            <translation>El enlace se perdió antes de que la pasarela respondiera, y no se volvió a enviar: después se pidió parar robots. Si había llegado antes, está en el registro de órdenes, y la parada lo termina.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: a robot shall not drive off on an old order. Look in the command log and send it again if it is not there.</source>
            <translation>El enlace se perdió antes de que la pasarela respondiera, y {age:.0f} s después no se repitió: un robot no debe arrancar por una orden antigua. Mire el registro de órdenes y vuelva a enviarla si no está.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: the robot may be doing something else by now. Look at the robot, and ask again if it shall still stop.</source>
            <translation>El enlace se perdió antes de que la pasarela respondiera, y {age:.0f} s después no se repitió: el robot puede estar haciendo ya otra cosa. Mire el robot y vuelva a pedirlo si todavía debe parar.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>the gateway takes no message as large as this one of {size} kB. Ask for less at once, or have largest_message_bytes raised in the site's settings.</source>
            <translation>la pasarela no acepta ningún mensaje tan grande como este, de {size} kB. Pida menos de una vez, o haga subir largest_message_bytes en la configuración del recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Keepouts and obstacles are not watched: the gateway tells nothing of them. It may be older than this plugin.</source>
            <translation>Las zonas prohibidas y los obstáculos no se vigilan: la pasarela no dice nada de ellos. Puede que sea más antigua que este complemento.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Keepouts and obstacles are not watched: {why}.</source>
            <translation>Las zonas prohibidas y los obstáculos no se vigilan: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Not judged by keepouts and obstacles, since it is not known where they are: {names}.</source>
            <translation>No juzgados por zonas prohibidas y obstáculos, porque no se sabe dónde están: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>People near robots are not watched: {why}.</source>
            <translation>No se vigilan las personas cerca de los robots: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>The published site has no keepouts.</source>
            <translation>El recinto publicado no tiene zonas prohibidas.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>The published site has no obstacles, so nobody is told to be at one.</source>
            <translation>El recinto publicado no tiene obstáculos, por lo que no se avisa de nadie que esté en uno.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>{more} more</source>
            <translation>{more} más</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>{more} more are in keepouts or at obstacles and not listed.</source>
            <translation>Hay {more} más en zonas prohibidas u obstáculos, sin listar.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>%n tasks</source>
            <translation>
                <numerusform>%n tarea</numerusform>
                <numerusform>%n tareas</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>, a path of {path_points} points</source>
            <translation>, un camino de {path_points} puntos</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>, {deviation:.2f} m off</source>
            <translation>, {deviation:.2f} m de desvío</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>. The robot is {state}: it is sent nothing until it is heard again</source>
            <translation>. El robot está {state}: no se le envía nada hasta que se vuelva a saber de él</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>Last: {task} {state} {time}{off}{why}</source>
            <translation>Última: {task} {state} {time}{off}{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>This desk is told of {known} of {all} robots: those in view, selected, or with an alarm.</source>
            <translation>Esta consola recibe noticias de {known} de {all} robots: los que se ven en el mapa, los seleccionados y los que tienen una alarma.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>aborted</source>
            <translation>abortada</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>acknowledged</source>
            <translation>reconocida</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>by {by}</source>
            <translation>por {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>collect cone</source>
            <translation>recoger cono</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>crossing</source>
            <translation>cruce</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>delivered</source>
            <translation>entregada</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>drive</source>
            <translation>circular</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>expired</source>
            <translation>caducada</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>failed</source>
            <translation>fallida</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>following</source>
            <translation>seguimiento</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>fresh</source>
            <translation>actual</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>head-on</source>
            <translation>de frente</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>lost</source>
            <translation>perdido</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>nothing to do</source>
            <translation>nada que hacer</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>now</source>
            <translation>ahora</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>offline</source>
            <translation>fuera de línea</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>place cone</source>
            <translation>colocar cono</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>queued</source>
            <translation>en cola</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>reached</source>
            <translation>alcanzada</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>removed</source>
            <translation>quitada</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>running</source>
            <translation>en marcha</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>skipped</source>
            <translation>omitido</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>stale</source>
            <translation>desactualizado</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>standing</source>
            <translation>parado</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>superseded</source>
            <translation>sustituida</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>unsure</source>
            <translation>inseguro</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>waiting</source>
            <translation>en espera</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{kind}{name} at {x:.2f}, {y:.2f}{way}</source>
            <translation>{kind}{name} en {x:.2f}, {y:.2f}{way}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{robot}: {count}, PAUSED{when}{why}</source>
            <translation>{robot}: {count}, EN PAUSA{when}{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{state}, may be elsewhere</source>
            <translation>{state}, puede estar en otro lugar</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source># Help

{file} cannot be read: {strerror}. Install the plugin again.</source>
            <translation># Ayuda

{file} no se puede leer: {strerror}. Vuelva a instalar el complemento.</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source>Fleet Supervisor help</source>
            <translation>Ayuda de Fleet Supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source>Fleet Supervisor: help</source>
            <translation>Fleet Supervisor: ayuda</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source> (EPSG:326xx north, EPSG:327xx south of the equator)</source>
            <translation> (EPSG:326xx al norte, EPSG:327xx al sur del ecuador)</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>The CRS {crs} cannot carry a site</source>
            <translation>El SRC {crs} no puede llevar un recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>The layers are in different CRSs ({names}), and nothing says which is the site's: give SITE_CRS, or set the project's CRS.</source>
            <translation>Las capas están en SRC distintos ({names}), y nada dice cuál es el del recinto: indique SITE_CRS, o defina el SRC del proyecto.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>without a name</source>
            <translation>sin nombre</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its coordinates are not metres on a plane. Choose a projected CRS such as the local UTM zone{suggestion}.</source>
            <translation>{named}: sus coordenadas no son metros en un plano. Elija un SRC proyectado como la zona UTM local{suggestion}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its metres are not metres; 1 m on the ground is 1.56 m there at latitude 50°. Choose the local UTM zone, such as EPSG:32633 for 12°E to 18°E.</source>
            <translation>{named}: sus metros no son metros; 1 m en el terreno son allí 1.56 m a 50° de latitud. Elija la zona UTM local, como EPSG:32633 de 12°E a 18°E.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its unit is {unit}, and robots speak metres. Choose a CRS in metres such as the local UTM zone{suggestion}.</source>
            <translation>{named}: su unidad es {unit}, y los robots hablan en metros. Elija un SRC en metros como la zona UTM local{suggestion}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source> at ({x:.2f} {y:.2f})</source>
            <translation> en ({x:.2f} {y:.2f})</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/geometry.py" />
            <source>%n different points</source>
            <translation>
                <numerusform>%n punto distinto</numerusform>
                <numerusform>%n puntos distintos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>courtyard {k} of part {number}{place} has {points} and encloses nothing; the courtyard is left out</source>
            <translation>el patio {k} de la parte {number}{place} tiene {points} y no encierra nada; el patio queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>has a coordinate that is no number, has no place in the site's CRS or lies beyond 100 000 km; it is left out</source>
            <translation>tiene una coordenada que no es un número, no tiene lugar en el SRC del recinto o está más allá de 100 000 km; se omite</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>has a {kind}, which is no area or line; it is left out</source>
            <translation>tiene un {kind}, que no es ni área ni línea; queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>its corners span no surface that one can drive on; its normal is left out</source>
            <translation>sus esquinas no forman ninguna superficie por la que se pueda circular; su normal queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>line {number} has fewer than two different points; it is left out</source>
            <translation>la línea {number} tiene menos de dos puntos distintos; queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>not valid</source>
            <translation>no es válido</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>riser {number} is bent; the straight line between its ends is used</source>
            <translation>el escalón {number} está curvado; se usa la recta entre sus extremos</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>the outer ring of part {number}{place} has {points} and encloses nothing; the part is left out</source>
            <translation>el anillo exterior de la parte {number}{place} tiene {points} y no encierra nada; la parte queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>the polygon is broken{place}: {what}</source>
            <translation>el polígono está roto{place}: {what}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>{fault}; it cannot be repaired and is left out</source>
            <translation>{fault}; no se puede reparar y queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>{fault}; it was repaired</source>
            <translation>{fault}; se reparó</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>Layer {layer}: it has no field {missing}, which the {what} expression {text!r} reads; the default is used for all its features</source>
            <translation>Capa {layer}: no tiene el campo {missing}, que lee la expresión de {what} {text!r}; se usa el valor por defecto para todos sus objetos espaciales</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>Layer {layer}: {note}</source>
            <translation>Capa {layer}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>The {what} expression {text!r} for the layer {layer} is not one: {error}. Correct it.</source>
            <translation>La expresión de {what} {text!r} para la capa {layer} no lo es: {error}. Corríjala.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>The {what} expression {text!r} for the layer {layer} reads the field {missing}, which the layer does not have. Correct it, or write attribute('...') for a field that some layers lack.</source>
            <translation>La expresión de {what} {text!r} para la capa {layer} lee el campo {missing}, que la capa no tiene. Corríjala, o escriba attribute('...') para un campo que falta en algunas capas.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>it is left out</source>
            <translation>queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its base {value!r} is not a number of metres; it is taken to stand on the ground</source>
            <translation>su base {value!r} no es un número de metros; se toma como si estuviera en el suelo</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its filter gives {value!r}, which is neither true nor false; it is left out</source>
            <translation>su filtro da {value!r}, que no es ni verdadero ni falso; queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its label has letters that cannot be read: set the layer's encoding (Properties &gt; Source), or put a .cpg file beside its shapefile</source>
            <translation>su etiqueta tiene letras que no se pueden leer: defina la codificación de la capa (Propiedades &gt; Fuente), o ponga un archivo .cpg junto al shapefile</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its outdoor flag {value!r} is neither true nor false; true is used</source>
            <translation>su indicador de exterior {value!r} no es ni verdadero ni falso; se usa verdadero</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its {what} {value!r} is not a number of metres above 0; the default is used</source>
            <translation>su {what} {value!r} no es un número de metros mayor que 0; se usa el valor por defecto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its {what} {value!r} is not a number of metres of 0 or more; {otherwise}</source>
            <translation>su {what} {value!r} no es un número de metros de 0 o más; {otherwise}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the default is used</source>
            <translation>se usa el valor por defecto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the estimate is used</source>
            <translation>se usa la estimación</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the {what} expression fails: {error}; {otherwise}</source>
            <translation>la expresión de {what} falla: {error}; {otherwise}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, feature {id}: {note}</source>
            <translation>Capa {layer}, objeto espacial {id}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, {features}: {note}</source>
            <translation>Capa {layer}, {features}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, {features}; of the first: {note}</source>
            <translation>Capa {layer}, {features}; del primero: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}: warnings of more kinds about {features}</source>
            <translation>Capa {layer}: avisos de más tipos sobre {features}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be opened ({source}): repair its data source or leave it out.</source>
            <translation>La capa {name} no se puede abrir ({source}): repare su origen de datos u omítala.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be read any more: QGIS gets none of its features. Its file or database was moved, damaged or cut off since the project was opened. Bring it back, or repair the layer's data source, and open the project again.</source>
            <translation>La capa {name} ya no se puede leer: QGIS no obtiene ninguno de sus objetos. Su archivo o base de datos se movió, se dañó o quedó sin conexión desde que se abrió el proyecto. Restablézcalo, o repare el origen de datos de la capa, y vuelva a abrir el proyecto.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be read to its end ({error}): its file is damaged, or was not copied whole. Replace it by a sound copy, or leave the layer out.</source>
            <translation>La capa {name} no se puede leer hasta el final ({error}): su archivo está dañado o no se copió entero. Sustitúyalo por una copia buena u omita la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} holds {held}, and only lines and polygons are obstacles: leave it out, give it an extent first (for example with Buffer), or the role furniture.</source>
            <translation>La capa {name} contiene {held}, y solo las líneas y los polígonos son obstáculos: omítala, déle antes extensión (por ejemplo con Buffer), o el papel mobiliario.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>feature {shown}</source>
            <translation>objeto espacial {shown}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>features {shown}</source>
            <translation>objetos espaciales {shown}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>features {shown} and {more} more</source>
            <translation>objetos espaciales {shown} y {more} más</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>no geometry</source>
            <translation>ninguna geometría</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>points</source>
            <translation>puntos</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: %n heights are not known and estimated as {height:g} m ({features})</source>
            <translation>
                <numerusform>Capa {name}: %n altura no se conoce y se estima en {height:g} m ({features})</numerusform>
                <numerusform>Capa {name}: %n alturas no se conocen y se estiman en {height:g} m ({features})</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: its role is {role}, yet it is exported as obstacles</source>
            <translation>Capa {name}: su papel es {role}, pero se exporta como obstáculos</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: its role {role} wants {wanted}; other features are exported as plain obstacles ({features})</source>
            <translation>Capa {name}: su papel {role} quiere {wanted}; los demás objetos espaciales se exportan como simples obstáculos ({features})</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>cannot be transformed into the site's CRS ({error}); it is left out</source>
            <translation>no se puede transformar al SRC del recinto ({error}); se omite</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>has no geometry; it is left out</source>
            <translation>no tiene geometría; se omite</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>its rotation {value!r} is not a number of degrees; it is not turned</source>
            <translation>su rotación {value!r} no es un número de grados; no se gira</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>its width {width:g} m is none of furniture; {used:g} is used</source>
            <translation>su anchura de {width:g} m no es de mobiliario; se usa {used:g}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>lines, one a riser</source>
            <translation>líneas, una por escalón</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>polygons</source>
            <translation>polígonos</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>{error}; its width is used</source>
            <translation>{error}; se usa su anchura</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Another publication of {site} into database {database} has ended meanwhile: publish again.</source>
            <translation>Entretanto ha terminado otra publicación de {site} en la base de datos {database}: publique de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>QGIS has no PostgreSQL connection {name}; it has: {known}. Make it in the browser panel, PostgreSQL &gt; New Connection, or write the address of the database, such as postgresql://account@host/database.</source>
            <translation>QGIS no tiene ninguna conexión PostgreSQL {name}; tiene: {known}. Créela en el panel del navegador, PostgreSQL &gt; Nueva conexión, o escriba la dirección de la base de datos, como postgresql://account@host/database.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>SITE_ID {site} is too long for a database: give one of at most {most} letters.</source>
            <translation>SITE_ID {site} es demasiado largo para una base de datos: dé uno de {most} letras como máximo.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Somebody has read or written {site} in database {database} for more than {seconds} s: wait until another publication has ended, close what shows its layers, and publish again.</source>
            <translation>Alguien lleva más de {seconds} s leyendo o escribiendo {site} en la base de datos {database}: espere a que termine otra publicación, cierre lo que muestra sus capas y publique de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Something of yours is made of the views of {site} in database {database}, which stand for one version: {error}. Remove it, publish, and make it again.</source>
            <translation>Algo suyo se basa en las vistas de {site} en la base de datos {database}, que ahora serán otras: {error}. Quítelo, publique y créelo de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The PostGIS of database {database} does not know {crs}: choose a SITE_CRS that its table spatial_ref_sys has, or have an administrator add this one there.</source>
            <translation>El PostGIS de la base de datos {database} no conoce {crs}: elija un SITE_CRS que esté en su tabla spatial_ref_sys, o haga que un administrador lo añada allí.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The Python package psycopg2 is missing in this QGIS, which writes to PostgreSQL: {install}</source>
            <translation>En este QGIS falta el paquete de Python psycopg2, que escribe en PostgreSQL: {install}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The account {account} may make no schemas in database {database}, and a site is published in some. Its owner runs: {command}</source>
            <translation>La cuenta {account} no puede crear esquemas en la base de datos {database}, y un recinto se publica en ellos. Su propietario ejecuta: {command}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The connection to database {database} was lost at the last moment: {site} is published there, or is as it was. Publish again.</source>
            <translation>La conexión con la base de datos {database} se perdió en el último momento: {site} está publicado allí, o está como estaba. Publique de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The database cannot be reached: {error}. Check that it runs, and the host, database, account and password of the connection.</source>
            <translation>No se puede acceder a la base de datos: {error}. Compruebe que funciona, y el servidor, la base de datos, la cuenta y la contraseña de la conexión.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The database {database} has no PostGIS. Install the package postgresql-15-postgis-3 (of your version) on the server, and as its administrator run in this database: create extension postgis</source>
            <translation>La base de datos {database} no tiene PostGIS. Instale en el servidor el paquete postgresql-15-postgis-3 (de su versión) y, como administrador, ejecute en esta base de datos: create extension postgis</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The schema {schema} of database {database} is of another program, or of another version of this one (it says “{found}”): publish with that, or into another database.</source>
            <translation>El esquema {schema} de la base de datos {database} es de otro programa, o de otra versión de este (dice «{found}»): publique con esa, o en otra base de datos.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The site cannot be published in database {database}: {error}. What was published there before is as it was.</source>
            <translation>El recinto no se puede publicar en la base de datos {database}: {error}. Lo que había publicado allí está como estaba.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The sites in database {database} belong to the account {owner}, and not to {account}: publish as {owner}, or have an administrator run: {command}</source>
            <translation>Los recintos de la base de datos {database} son de la cuenta {owner}, y no de {account}: publique como {owner}, o haga que un administrador ejecute: {command}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>install the distribution's package, such as python3-psycopg2.</source>
            <translation>instale el paquete de la distribución, como python3-psycopg2.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Another publication into {folder} is under way, by {who}: wait until it has ended, or choose another folder. If it ended on another computer without a word, remove {file}.</source>
            <translation>Otra publicación en {folder} está en curso, de {who}: espere a que acabe, o elija otra carpeta. Si acabó en otro ordenador sin decir nada, borre {file}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Keepouts</source>
            <translation>Zonas prohibidas</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Obstacles</source>
            <translation>Obstáculos</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Publish the site again.</source>
            <translation>Vuelva a publicar el recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Road centrelines</source>
            <translation>Ejes de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Road surfaces</source>
            <translation>Superficies de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>The site cannot be published in {folder}: {file} is a file. Choose a folder: a new one, or the one that the site was published in before.</source>
            <translation>El recinto no se puede publicar en {folder}: {file} es un archivo. Elija una carpeta: una nueva o la misma en la que ya se publicó el recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>The site cannot be published in {folder}: {reason}. Check the folder's rights and the free space.</source>
            <translation>El recinto no se puede publicar en {folder}: {reason}. Compruebe los permisos de la carpeta y el espacio libre.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>another process</source>
            <translation>otro proceso</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>no file {lock_file} can be made in it</source>
            <translation>no se puede crear en ella ningún archivo {lock_file}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>process {process} on {host}</source>
            <translation>el proceso {process} en {host}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} cannot be read: {error}</source>
            <translation>{file} no se puede leer: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} has no layer {layers} that can be read. {again}</source>
            <translation>{file} no tiene ninguna capa {layers} que se pueda leer. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} is there and is no part of a published site: choose another folder, or say that it may be replaced (REPLACE=true).</source>
            <translation>{file} está ahí y no forma parte de un recinto publicado: elija otra carpeta, o diga que se puede sustituir (REPLACE=true).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} names no site: it has no table [site] with a name. {again}</source>
            <translation>{file} no nombra ningún recinto: no tiene la tabla [site] con un nombre. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{folder} has a {settings} and no {geopackage}. {again}</source>
            <translation>{folder} tiene {settings} y no {geopackage}. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{folder} holds version {version} of another site, {other}: choose another folder for {site}, or say that the other site may be replaced (REPLACE=true).</source>
            <translation>{folder} contiene la versión {version} de otro recinto, {other}: elija otra carpeta para {site}, o diga que el otro recinto se puede sustituir (REPLACE=true).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>GDAL does not say why</source>
            <translation>GDAL no dice por qué</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>The Python bindings of GDAL (osgeo) are missing in this QGIS, which write site.gpkg: install the distribution's package, such as python3-gdal.</source>
            <translation>En este QGIS faltan los enlaces de Python de GDAL (osgeo), que escriben site.gpkg: instale el paquete de la distribución, como python3-gdal.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>{file} cannot be written in {folder}: {error}. Check the folder's rights and the free space.</source>
            <translation>{file} no se puede escribir en {folder}: {error}. Compruebe los permisos de la carpeta y el espacio libre.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/reading.py" />
            <source>The layer {layer} has not answered for {seconds:g} s. Bring its server or drive back and try again.</source>
            <translation>La capa {layer} no responde desde hace {seconds:g} s. Restablezca su servidor o su unidad e inténtelo de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>Layer {layer}: the width of {count} of its roads is not known and taken as {width:g} m (feature {first} is the first)</source>
            <translation>Capa {layer}: la anchura de {count} de sus vías no se conoce y se toma como {width:g} m (el objeto espacial {first} es el primero)</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>has a line, which is no area; it is left out</source>
            <translation>tiene una línea, que no es un área; queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>has a polygon, which is no centreline; it is left out</source>
            <translation>tiene un polígono, que no es un eje de vía; queda fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its direction {value!r} is none of yes, -1 and no; it is taken as driven both ways</source>
            <translation>su sentido {value!r} no es yes, -1 ni no; se toma como de doble sentido</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its level {value!r} is no number; it is taken to be on the ground</source>
            <translation>su nivel {value!r} no es un número; se toma como si estuviera en el suelo</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its speed {value!r} is no number above 0; the default is used</source>
            <translation>su velocidad {value!r} no es un número mayor que 0; se usa el valor por defecto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>none of its fields direction, oneway, one_way and other_tags is there to tell one-way roads; all are taken as driven both ways</source>
            <translation>no hay ninguno de los campos direction, oneway, one_way y other_tags que diga qué vías son de sentido único; todas se toman como de doble sentido</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>whether it is closed, {value!r}, is neither true nor false; it is taken as closed</source>
            <translation>si está cerrada, {value!r}, no es ni verdadero ni falso; se toma como cerrada</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_surfaces.py" />
            <source>the road surfaces are still being read ({layers}): try again soon</source>
            <translation>las superficies de vía todavía se están leyendo ({layers}): inténtelo de nuevo pronto</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n keepouts</source>
            <translation>
                <numerusform>%n zona prohibida</numerusform>
                <numerusform>%n zonas prohibidas</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n layers refused</source>
            <translation>
                <numerusform>%n capa rechazada</numerusform>
                <numerusform>%n capas rechazadas</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n obstacles</source>
            <translation>
                <numerusform>%n obstáculo</numerusform>
                <numerusform>%n obstáculos</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n roads</source>
            <translation>
                <numerusform>%n vía</numerusform>
                <numerusform>%n vías</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n segments</source>
            <translation>
                <numerusform>%n segmento</numerusform>
                <numerusform>%n segmentos</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n surfaces</source>
            <translation>
                <numerusform>%n superficie</numerusform>
                <numerusform>%n superficies</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n warnings</source>
            <translation>
                <numerusform>%n aviso</numerusform>
                <numerusform>%n avisos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>Preview of the site</source>
            <translation>Vista previa del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>refused</source>
            <translation>rechazada</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>{metres:g} m</source>
            <translation>{metres:g} m</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>{obstacles} of {segments}</source>
            <translation>{obstacles} de {segments}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Comes to</source>
            <translation>Resultado</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Estimate [m]</source>
            <translation>Estimación [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for metres above the ground where it begins, as of an arch; empty: 0</source>
            <translation>Expresión para los metros sobre el suelo donde empieza, como un arco; vacía: 0</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for metres from the foot up; empty: the field height or height_m</source>
            <translation>Expresión para los metros desde el pie hacia arriba; vacía: el campo height o height_m</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the degrees clockwise that the template is turned; empty: 0</source>
            <translation>Expresión para los grados que se gira la plantilla en sentido horario; vacía: 0</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the height where it is not known, such as 3 * "levels"; marked as estimated</source>
            <translation>Expresión para la altura donde no se conoce, como 3 * "levels"; marcada como estimada</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the label, such as 'building,' || "name"; of a road its surface</source>
            <translation>Expresión para la etiqueta, como 'building,' || "name"; de una vía, su superficie</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the metres across, of a road or of furniture that is points</source>
            <translation>Expresión para los metros de ancho, de una vía o de mobiliario que son puntos</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the shape that a point of furniture stands for: {shapes}, 'circle 0.6', 'square 1' or 'rectangle 2 0.5'; empty: an octagon of its width</source>
            <translation>Expresión para la forma que representa un punto de mobiliario: {shapes}, 'circle 0.6', 'square 1' o 'rectangle 2 0.5'; vacía: un octágono de su anchura</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for true or false; empty: true</source>
            <translation>Expresión para cierto o falso; vacía: cierto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression that is true of the features that count, such as "amenity" = 'bench'; empty: all</source>
            <translation>Expresión cierta para los objetos que cuentan, como "amenity" = 'bench'; vacía: todos</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Filter</source>
            <translation>Filtro</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Foot [m]</source>
            <translation>Pie [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Height [m]</source>
            <translation>Altura [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Label</source>
            <translation>Etiqueta</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Layer</source>
            <translation>Capa</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Layers of the project that can have a role</source>
            <translation>Capas del proyecto que pueden tener un papel</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Outdoors</source>
            <translation>Exterior</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Template</source>
            <translation>Plantilla</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Turned [°]</source>
            <translation>Girado [°]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>What is published of the layer</source>
            <translation>Qué se publica de la capa</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>What the layer is to robots and operators</source>
            <translation>Qué es la capa para los robots y los operadores</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Width [m]</source>
            <translation>Anchura [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>furniture</source>
            <translation>mobiliario</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>keepout</source>
            <translation>zona prohibida</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>obstacle</source>
            <translation>obstáculo</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>orthophoto</source>
            <translation>ortofoto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>ramp</source>
            <translation>rampa</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>road centreline</source>
            <translation>eje de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>road surface</source>
            <translation>superficie de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>stairs</source>
            <translation>escalera</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Apply profile</source>
            <translation>Aplicar perfil</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Layer roles</source>
            <translation>Papeles de las capas</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Layer roles…</source>
            <translation>Papeles de las capas…</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Map profile</source>
            <translation>Perfil de mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Map profile ({kinds})</source>
            <translation>Perfil de mapa ({kinds})</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Map profile:</source>
            <translation>Perfil de mapa:</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Profile from file…</source>
            <translation>Perfil de un archivo…</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Reading %n layers …</source>
            <translation>
                <numerusform>Leyendo %n capa …</numerusform>
                <numerusform>Leyendo %n capas …</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Say what each layer of the project is to robots</source>
            <translation>Diga qué es cada capa del proyecto para los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>{name} knows none of these layers. It looks for layers that are named, in their source or in the project: {sought}.</source>
            <translation>{name} no conoce ninguna de estas capas. Busca capas que, en su origen o en el proyecto, se llamen: {sought}.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>{name}: {known} of %n layers set up.</source>
            <translation>
                <numerusform>{name}: {known} de %n capa configurada.</numerusform>
                <numerusform>{name}: {known} de %n capas configuradas.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>The profile {file} cannot be read: {error}.</source>
            <translation>El perfil {file} no se puede leer: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>The profile {file} is not there: give the path of a file, or one of {shipped}.</source>
            <translation>El perfil {file} no está: dé la ruta de un archivo, o uno de {shipped}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>it has {count} characters, more than {most}</source>
            <translation>tiene {count} caracteres, más de {most}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} cannot be read: this QGIS runs Python older than 3.11, which reads no TOML. Save the profile with the same keys as JSON and choose that file.</source>
            <translation>{file} no se puede leer: este QGIS usa un Python anterior a 3.11, que no lee TOML. Guarde el perfil con las mismas claves como JSON y elija ese archivo.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} is no profile: write an object with name and layers.</source>
            <translation>{file} no es un perfil: escriba un objeto con name y layers.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} is not valid {kind}: {error}. Correct that place.</source>
            <translation>{file} no es {kind} válido: {error}. Corrija ese lugar.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: layers is missing or empty: write one table [[layers]] or more.</source>
            <translation>{file}: layers falta o está vacío: escriba una o más tablas [[layers]].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key} fits no layer: write names = ["*building*"] or fields = ["building"].</source>
            <translation>{file}: {key} no encaja con ninguna capa: escriba names = ["*building*"] o fields = ["building"].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key} is {content!r}: write a table [[layers]].</source>
            <translation>{file}: {key} es {content!r}: escriba una tabla [[layers]].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.geometry is {geometry!r}: write one of {geometries}.</source>
            <translation>{file}: {key}.geometry es {geometry!r}: escriba uno de {geometries}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.role is {role!r}: write one of {roles}.</source>
            <translation>{file}: {key}.role es {role!r}: escriba uno de {roles}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.{name} is no QGIS expression: {error}. Correct it.</source>
            <translation>{file}: {key}.{name} no es una expresión de QGIS: {error}. Corríjala.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.{name} is {value!r}: write a list of texts, such as ["walls"].</source>
            <translation>{file}: {key}.{name} es {value!r}: escriba una lista de textos, como ["walls"].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {prefix}{name} is no key of a profile: known are {known}. Remove it or correct its name.</source>
            <translation>{file}: {prefix}{name} no es una clave de perfil: las conocidas son {known}. Quítela o corrija su nombre.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {prefix}{name} is {value!r}: write text in quotes.</source>
            <translation>{file}: {prefix}{name} es {value!r}: escriba texto entre comillas.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{names} with {fields}</source>
            <translation>{names} con {fields}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>A position in {crs} has no place in {target} ({error}). Choose the site's CRS as the project's CRS (bottom right in the QGIS window).</source>
            <translation>Una posición en {crs} no tiene lugar en {target} ({error}). Elija el SRC del recinto como SRC del proyecto (abajo a la derecha en la ventana de QGIS).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>A way accurate to {accuracy:g} m needs the grid {grids}, which is not installed.</source>
            <translation>Una vía con exactitud de {accuracy:g} m necesita la malla {grids}, que no está instalada.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>By {name} ({exact}).{warning}</source>
            <translation>Por {name} ({exact}).{warning}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>Layer {layer}: its features may lie metres off on the site. They come from {crs} to {site_crs}. {way} Choose another transformation in the project's properties, or save the layer in the site's CRS by an exact one.</source>
            <translation>Capa {layer}: sus objetos espaciales pueden quedar a metros de su lugar en el recinto. Pasan de {crs} a {site_crs}. {way} Elija otra transformación en las propiedades del proyecto, o guarde la capa en el SRC del recinto con una exacta.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>PROJ knows no exact way between these two: the place may be off by metres.</source>
            <translation>PROJ no conoce ninguna vía exacta entre estos dos: el lugar puede fallar por metros.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} has no CRS, so its place is not known: set the layer's CRS (Layer &gt; Set CRS of Layer).</source>
            <translation>La capa {name} no tiene SRC, por eso no se conoce su lugar: defina el SRC de la capa (Capa &gt; Establecer SRC de la capa).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} has no CRS, so its place on the site is not known: set the layer's CRS (Layer &gt; Set CRS of Layer), or {tick}.</source>
            <translation>La capa {name} no tiene SRC, así que su lugar en el recinto no se conoce: defina el SRC de la capa (Capa &gt; Establecer SRC de la capa), o {tick}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} is in the CRS {crs}, which has no known relation to the CRS {site_crs}: give both layers a CRS that says where on the Earth they are.</source>
            <translation>La capa {name} está en el SRC {crs}, que no tiene relación conocida con el SRC {site_crs}: dé a ambas capas un SRC que diga dónde están en la Tierra.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} is in the CRS {crs}, which has no known relation to the site CRS {site_crs}: choose the layer's CRS as the site CRS, or {tick}.</source>
            <translation>La capa {name} está en el SRC {crs}, que no tiene relación conocida con el SRC del recinto {site_crs}: elija el SRC de la capa como SRC del recinto, o {tick}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The site is not known yet. Connect to a gateway first.</source>
            <translation>El recinto aún no se conoce. Conéctese antes a una pasarela.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The site {name} is in the CRS {crs}, which this QGIS does not know: its robots cannot be placed on the map. Correct crs in the site's site.toml, or update QGIS.</source>
            <translation>El recinto {name} está en el SRC {crs}, que este QGIS no conoce: sus robots no se pueden situar en el mapa. Corrija crs en el site.toml del recinto, o actualice QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>There is no way from {site} to {crs}. Choose another CRS under Columns.</source>
            <translation>No hay ninguna vía de {site} a {crs}. Elija otro SRC en Columnas.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>accuracy not known</source>
            <translation>exactitud desconocida</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>accurate to {accuracy:g} m</source>
            <translation>exactitud de {accuracy:g} m</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>exact</source>
            <translation>exacto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>no change: it is the site's CRS</source>
            <translation>ningún cambio: es el SRC del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>not a finite place</source>
            <translation>no es un lugar finito</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>nothing is known of how the two lie to each other</source>
            <translation>no se sabe cómo se relacionan uno con otro</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>site frame</source>
            <translation>marco del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>the default operation of PROJ</source>
            <translation>la operación por defecto de PROJ</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>tick 'Layers without a CRS are in metres of the site' (LOCAL=true)</source>
            <translation>marque «Las capas sin SRC están en metros del recinto» (LOCAL=true)</translation>
        </message>
        <message>
            <location filename="../../plugin/locator.py" />
            <source>Robots</source>
            <translation>Robots</translation>
        </message>
        <message>
            <location filename="../../plugin/locator.py" />
            <source>{state}, heard of {age:.0f} s ago</source>
            <translation>{state}, último mensaje hace {age:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>All robots cannot be followed.</source>
            <translation>No se pueden seguir todos los robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>No robot is selected to be followed. Select one in the table or on the map.</source>
            <translation>No hay ningún robot seleccionado para seguir. Seleccione uno en la tabla o en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>{robot} has not said yet where it is; the map cannot go there.</source>
            <translation>{robot} aún no ha dicho dónde está; el mapa no puede ir allí.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>, {remaining:.1f} m to go</source>
            <translation>, faltan {remaining:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>accuracy</source>
            <translation>precisión</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>battery</source>
            <translation>batería</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>heading</source>
            <translation>rumbo</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>it says</source>
            <translation>dice</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>last message</source>
            <translation>último mensaje</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>place</source>
            <translation>lugar</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>speed</source>
            <translation>velocidad</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>task</source>
            <translation>tarea</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>why</source>
            <translation>por qué</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{age_in_words} ago, {escape}</source>
            <translation>hace {age_in_words}, {escape}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{v:.2f} m/s</source>
            <translation>{v:.2f} m/s</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{x:.2f}, {y:.2f} m in the site</source>
            <translation>{x:.2f}, {y:.2f} m en el recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>± {accuracy:.2f} m</source>
            <translation>± {accuracy:.2f} m</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/map/overlay/grouped_robots.py" />
            <source>%n robots here, shown as a density; zoom in to see each</source>
            <translation>
                <numerusform>%n robot aquí, mostrado como densidad; amplíe el mapa para verlo</numerusform>
                <numerusform>%n robots aquí, mostrados como densidad; amplíe el mapa para verlos uno a uno</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>{days:.0f} d</source>
            <translation>{days:.0f} d</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>{hours:.0f} h</source>
            <translation>{hours:.0f} h</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>{minutes:.0f} min</source>
            <translation>{minutes:.0f} min</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>{seconds:.0f} s</source>
            <translation>{seconds:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>· offline</source>
            <translation>· sin conexión</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/task_painter.py" />
            <source>{km:.0f} km</source>
            <translation>{km:.0f} km</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/task_painter.py" />
            <source>{metres:.0f} m</source>
            <translation>{metres:.0f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Accuracy (m)</source>
            <translation>Exactitud (m)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Age (s)</source>
            <translation>Antigüedad (s)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Battery (0 to 1)</source>
            <translation>Batería (0 a 1)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Closed roads</source>
            <translation>Vías cerradas</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Command</source>
            <translation>Orden</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Cones put down</source>
            <translation>Conos puestos</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Conflicts</source>
            <translation>Conflictos</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Heading (°)</source>
            <translation>Rumbo (°)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Link</source>
            <translation>Enlace</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Robot</source>
            <translation>Robot</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Robots (live)</source>
            <translation>Robots (en vivo)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Speed (m/s)</source>
            <translation>Velocidad (m/s)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Status</source>
            <translation>Situación</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Theta (rad)</source>
            <translation>Theta (rad)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>closed</source>
            <translation>cerrada</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>until</source>
            <translation>hasta</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Close road</source>
            <translation>Cerrar vía</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Closed</source>
            <translation>Cerrada</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Open it again for every robot?</source>
            <translation>¿Volver a abrirla a todos los robots?</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Open road</source>
            <translation>Abrir la vía</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Reason</source>
            <translation>Motivo</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>The road is closed for every robot from this junction to the next. Robots whose way leads along it get another way; one that has no other way is stopped, unless the site's settings say otherwise.</source>
            <translation>La vía se cierra a todos los robots desde este cruce hasta el siguiente. Los que debían pasar por ella reciben otro recorrido; el que no tiene otro se detiene, si la configuración del recinto no dice otra cosa.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 1 hour</source>
            <translation>durante 1 hora</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 15 minutes</source>
            <translation>durante 15 minutos</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 4 hours</source>
            <translation>durante 4 horas</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>such as: tree on the road</source>
            <translation>como: árbol en la vía</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>until it is opened</source>
            <translation>hasta que se abra</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>{by} closed this road at {time}{because}</source>
            <translation>{by} cerró esta vía a las {time}{because}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>No robot is selected, so there is nobody to send there. Select one in the table or on the map.</source>
            <translation>No hay ningún robot seleccionado, así que no hay a quién enviar. Seleccione uno en la tabla o en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>Select a robot first, in the table or on the map.</source>
            <translation>Seleccione antes un robot, en la tabla o en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>The site or the map's CRS has changed meanwhile. Draw the start position again.</source>
            <translation>Mientras tanto ha cambiado el recinto o el SRC del mapa. Dibuje de nuevo la posición inicial.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>There is nothing to do again.</source>
            <translation>No hay nada que rehacer.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>There is nothing to take back.</source>
            <translation>No hay nada que deshacer.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>{in_words} is still on the map. Send it (Enter) or cancel it (Esc) first.</source>
            <translation>{in_words} sigue en el mapa. Envíelo (Intro) o cancélelo (Esc) antes.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>No layer of the project has the role road surface: set it in Plugins &gt; Fleet Supervisor &gt; Layer roles.</source>
            <translation>Ninguna capa del proyecto tiene el papel superficie de vía: póngalo en Complementos &gt; Fleet Supervisor &gt; Papeles de las capas.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>No road surface</source>
            <translation>Ninguna superficie de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>Tell the road surface under the cursor; a click says it with its coordinates, Esc ends</source>
            <translation>Decir la superficie de vía bajo el cursor; un clic la dice con sus coordenadas, Esc termina</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>The ways to the %n places clicked last were not known yet, so they are not in the route.</source>
            <translation>
                <numerusform>Aún no se conocía el camino hasta %n lugar donde hizo el último clic, así que no está en la ruta.</numerusform>
                <numerusform>Aún no se conocían los caminos hasta los %n lugares donde hizo los últimos clics, así que no están en la ruta.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>This leg does not follow the roads: {note}</source>
            <translation>Este tramo no sigue las vías: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>Which road surface is here?</source>
            <translation>¿Qué superficie de vía hay aquí?</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>no CRS</source>
            <translation>sin SRC</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>no road surface</source>
            <translation>ninguna superficie de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>road surface without a class</source>
            <translation>superficie de vía sin clase</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>{surface} at {where}</source>
            <translation>{surface} en {where}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>{why} (Nor are the %n places clicked after it in the route.)</source>
            <translation>
                <numerusform>{why} (Tampoco está en la ruta %n lugar donde hizo clic después.)</numerusform>
                <numerusform>{why} (Tampoco están en la ruta los %n lugares donde hizo clic después.)</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>A route needs at least two points, so its drawing goes on: click the next one.</source>
            <translation>Una ruta necesita al menos dos puntos, así que el dibujo continúa: haga clic en el siguiente.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Keep off roads on which other robots are sent</source>
            <translation>Evitar las vías por las que se han enviado otros robots</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Lead ways so</source>
            <translation>Llevar así</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Surfaces</source>
            <translation>Superficies</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>The route on the map is for {robot}, but {selected} is selected. Send it (Enter) or cancel it (Esc) first, or select {robot} again.</source>
            <translation>La ruta del mapa es para {robot}, pero el seleccionado es {selected}. Envíela (Intro) o cancélela (Esc) primero, o vuelva a seleccionar {robot}.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>This holds for every leg that is led from now on, until QGIS is closed.</source>
            <translation>Esto vale para cada tramo que se trace a partir de ahora, hasta que se cierre QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>This is the first vertex: another is put before one that comes later.</source>
            <translation>Este es el primer vértice: se pone otro delante de uno que viene después.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Way</source>
            <translation>Recorrido</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Ways on roads</source>
            <translation>Caminos por vías</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Width</source>
            <translation>Anchura</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>all, or such as: asphalt, concrete</source>
            <translation>todas, o como: asphalt, concrete</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>as wide as the robots are</source>
            <translation>tan ancha como los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>the fastest</source>
            <translation>el más rápido</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>the shortest</source>
            <translation>el más corto</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Accept</source>
            <translation>Aceptar</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>All are reviewed.</source>
            <translation>Todas están revisadas.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>An image of {object}, told by {robot}, at {x:.2f}, {y:.2f} m.</source>
            <translation>Una imagen de {object}, enviada por {robot}, en {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>An object: {object}, told by {robot}, at {x:.2f}, {y:.2f} m.</source>
            <translation>Un objeto: {object}, comunicado por {robot}, en {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Draw it on no map</source>
            <translation>No dibujarlo en ningún mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Go to it on the map</source>
            <translation>Ir allí en el mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Height</source>
            <translation>Altura</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is a</source>
            <translation>Es un</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is gone: leave it out of the maps that robots get from now on</source>
            <translation>Ya no está: no sale en los mapas que los robots reciban a partir de ahora</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is there: leave it on the maps</source>
            <translation>Está ahí: queda en los mapas</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It stands there: draw it on the maps that robots get from now on</source>
            <translation>Está ahí: dibujarlo en los mapas que los robots reciban desde ahora</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It waits for your review.</source>
            <translation>Espera su revisión.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Look at it: is it of use?</source>
            <translation>Mírela: ¿es útil?</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>No robot has told of an object or image yet.</source>
            <translation>Ningún robot ha informado aún de un objeto o una imagen.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Not there any more? {robot} looks through {what} ({source}) of its map again and again, at {x:.2f}, {y:.2f} m.</source>
            <translation>¿Ya no está? {robot} ve una y otra vez a través de {what} ({source}) de su mapa, en {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Objects and images that robots told of, to be accepted for the maps or rejected</source>
            <translation>Objetos e imágenes de los que informaron los robots, para aceptarlos en los mapas o rechazarlos</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observation {number} was not reviewed: {why}</source>
            <translation>La observación {number} no se revisó: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observation {observation} was NOT reviewed: {error}</source>
            <translation>La observación {observation} NO se revisó: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observations</source>
            <translation>Observaciones</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observations ({waiting})</source>
            <translation>Observaciones ({waiting})</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Radius</source>
            <translation>Radio</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Reject</source>
            <translation>Rechazar</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Show</source>
            <translation>Mostrar</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Show reviewed ones, too</source>
            <translation>Mostrar también las revisadas</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>State: {state}, by {by}. A new review takes the place of that.</source>
            <translation>Estado: {state}, por {by}. Una revisión nueva la sustituye.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>State: {state}. A new review takes the place of that.</source>
            <translation>Estado: {state}. Una revisión nueva la sustituye.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>not known</source>
            <translation>no se sabe</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>object</source>
            <translation>objeto</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>optional</source>
            <translation>opcional</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>{waiting} to be reviewed</source>
            <translation>{waiting} por revisar</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>Observation {number} at {x:.2f}, {y:.2f} m; double click goes there</source>
            <translation>Observación {number} en {x:.2f}, {y:.2f} m; un doble clic va allí</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>What robots saw is not known: {error}</source>
            <translation>No se sabe qué vieron los robots: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>accepted</source>
            <translation>aceptada</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>image</source>
            <translation>imagen</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>not there any more: {what}</source>
            <translation>ya no está: {what}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>rejected</source>
            <translation>rechazada</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>to be reviewed</source>
            <translation>por revisar</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>{state} by {by}</source>
            <translation>{state} por {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>&amp;Folder for files that are written</source>
            <translation>&amp;Carpeta de los archivos que se escriben</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>&amp;Size of robots on the map</source>
            <translation>&amp;Tamaño de los robots en el mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>1 is as they come</source>
            <translation>1 es el tamaño original</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Alarms</source>
            <translation>Alarmas</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Arrows show how each robot is, and move with every position. The layer shows what its style says, as often as it is written anew; while it is not on the map there are arrows</source>
            <translation>Las flechas muestran cómo está cada robot y se mueven con cada posición. La capa muestra lo que dice su estilo, tan a menudo como se vuelve a escribir; mientras no está en el mapa hay flechas</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>At most; from the next connection on. Fewer spare a slow network</source>
            <translation>Como máximo; desde la próxima conexión. Menos alivian una red lenta</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Connections</source>
            <translation>Conexiones</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Fleet Supervisor &amp;help</source>
            <translation>&amp;Ayuda de Fleet Supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Layer of robots written anew &amp;every</source>
            <translation>La capa de robots se reescribe &amp;cada</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Map and files</source>
            <translation>Mapa y archivos</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Positions asked for, &amp;times a second</source>
            <translation>Posiciones pedidas, &amp;veces por segundo</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Robots are &amp;drawn by</source>
            <translation>Quién &amp;dibuja los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>The layer Robots (live): attribute table, labels, expressions. The live map goes its own way</source>
            <translation>La capa Robots (en vivo): tabla de atributos, etiquetas, expresiones. El mapa en vivo va por su cuenta</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>the layer Robots (live), in its style</source>
            <translation>la capa Robots (en vivo), con su estilo</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>the live map: arrows</source>
            <translation>el mapa en vivo: flechas</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>your documents</source>
            <translation>sus documentos</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>%n lines written to {path}</source>
            <translation>
                <numerusform>%n línea escrita en {path}</numerusform>
                <numerusform>%n líneas escritas en {path}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Acknowledge</source>
            <translation>Reconocer</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Acknowledge all</source>
            <translation>Reconocer todas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Alarm</source>
            <translation>Alarma</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Alarm settings</source>
            <translation>Configuración de las alarmas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>By</source>
            <translation>Quién</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>CSV (*.csv)</source>
            <translation>CSV (*.csv)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Every alarm of this session, and who acknowledged it when</source>
            <translation>Todas las alarmas de la sesión, y quién las reconoció y cuándo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Export CSV…</source>
            <translation>Exportar CSV…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Export the log of alarms</source>
            <translation>Exportar el registro de alarmas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Kind</source>
            <translation>Tipo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Log of alarms</source>
            <translation>Registro de alarmas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Log…</source>
            <translation>Registro…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Say that you have seen every alarm</source>
            <translation>Indicar que ha visto todas las alarmas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Say that you have seen the chosen alarms</source>
            <translation>Indicar que ha visto las alarmas elegidas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Settings…</source>
            <translation>Configuración…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Time</source>
            <translation>Hora</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>What</source>
            <translation>Qué</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>What is an alarm, and from where on</source>
            <translation>Qué es una alarma, y a partir de dónde</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>acknowledged {time} by {operator}</source>
            <translation>reconocida a las {time} por {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>it began {times} times</source>
            <translation>ha empezado {times} veces</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>over</source>
            <translation>terminada</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>over since {time}, not acknowledged yet</source>
            <translation>terminada desde las {time}, aún sin reconocer</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>since {time}</source>
            <translation>desde las {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>the gateway judges it by the published site, and says what it does</source>
            <translation>la pasarela lo juzga según el recinto publicado y dice qué hace</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>the site's settings say after how long (see the robots' state)</source>
            <translation>la configuración del recinto dice al cabo de cuánto (vea el estado de los robots)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source> at {x:.1f}, {y:.1f} m</source>
            <translation> en {x:.1f}, {y:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>began</source>
            <translation>empezada</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>ended</source>
            <translation>terminada</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it could NOT be stopped yet: {why}</source>
            <translation>todavía NO se ha podido parar: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it is being aborted</source>
            <translation>se está abortando</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it is being paused</source>
            <translation>se está poniendo en pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>new</source>
            <translation>nueva</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>seen</source>
            <translation>vista</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the emergency stop holds it</source>
            <translation>la parada de emergencia lo retiene</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the gateway has aborted its task</source>
            <translation>la pasarela ha abortado su tarea</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the gateway has paused it</source>
            <translation>la pasarela lo ha puesto en pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} and {other}</source>
            <translation>{robot} y {other}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} is at the obstacle {name}</source>
            <translation>{robot} está en el obstáculo {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} is in the keepout {name}</source>
            <translation>{robot} está en la zona prohibida {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} will pass {other} at {metres:.1f} m (clearance {clearance:.1f} m){where}</source>
            <translation>{robot} pasará a {metres:.1f} m de {other} (distancia mínima {clearance:.1f} m){where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} will pass {other} at {metres:.1f} m{where}</source>
            <translation>{robot} pasará a {metres:.1f} m de {other}{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{seen} comes within {metres:.1f} m of {robot} in {seconds:.0f} s</source>
            <translation>{seen} estará a menos de {metres:.1f} m de {robot} en {seconds:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{seen} is {metres:.1f} m from {robot}</source>
            <translation>{seen} está a {metres:.1f} m de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{text} (it is not heard now)</source>
            <translation>{text} (ahora no se le oye)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{text}; {robot} may be elsewhere</source>
            <translation>{text}; {robot} puede estar en otro lugar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>; last{where}</source>
            <translation>; la última vez{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>at an obstacle</source>
            <translation>en un obstáculo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins after standing with a task for</source>
            <translation>empieza después de estar parado con una tarea durante</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins below</source>
            <translation>empieza por debajo de</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so far beside the road</source>
            <translation>empieza tanto al lado de la vía</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so far outside</source>
            <translation>empieza tanto fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so long before</source>
            <translation>empieza este tiempo antes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins when less exact than</source>
            <translation>empieza cuando es menos exacta que</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins when two are nearer than</source>
            <translation>empieza cuando dos están más cerca de</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much above that</source>
            <translation>termina tanto por encima</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much below that</source>
            <translation>termina tanto por debajo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much further apart</source>
            <translation>termina tanto más lejos</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>in a keepout</source>
            <translation>en una zona prohibida</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>low battery</source>
            <translation>batería baja</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>near a robot</source>
            <translation>cerca de un robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>off the road</source>
            <translation>fuera de la vía</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>outside the site</source>
            <translation>fuera del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>stopped unasked</source>
            <translation>parado sin pedirlo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>too close</source>
            <translation>demasiado cerca</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>unsure of its place</source>
            <translation>inseguro de su lugar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>will come near a robot</source>
            <translation>se acercará a un robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>will pass too near</source>
            <translation>pasará demasiado cerca</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} and {other} are {apart:.1f} m apart{where}</source>
            <translation>{robot} y {other} están a {apart:.1f} m uno de otro{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} does not know its place: ± {accuracy:.1f} m{where}</source>
            <translation>{robot} no sabe dónde está: ± {accuracy:.1f} m{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} has a task and stands{where}</source>
            <translation>{robot} tiene una tarea y está parado{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} has {part:.0%} of its battery left</source>
            <translation>a {robot} le queda el {part:.0%} de la batería</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is lost: nothing is heard of it{last}</source>
            <translation>{robot} está perdido: no se sabe nada de él{last}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is off the road{where}</source>
            <translation>{robot} está fuera de la vía{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is outside the site{where}</source>
            <translation>{robot} está fuera del recinto{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} may not be where it is shown: {why}</source>
            <translation>{robot} puede no estar donde se muestra: {why}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>%n alarms</source>
            <translation>
                <numerusform>%n alarma</numerusform>
                <numerusform>%n alarmas</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Nothing is watched: the desk is not connected.</source>
            <translation>No se vigila nada: la consola no está conectada.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Off the road is not watched: {why}.</source>
            <translation>No se vigila si salen de la vía: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Switched off: {kinds}.</source>
            <translation>Desactivadas: {kinds}.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>and %n more alarms: see the log of alarms in the Fleet panel</source>
            <translation>
                <numerusform>y %n alarma más: vea el registro de alarmas en el panel de la flota</numerusform>
                <numerusform>y %n alarmas más: vea el registro de alarmas en el panel de la flota</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>layers of road surfaces cannot be read: {why}</source>
            <translation>las capas de superficies de vía no se pueden leer: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>layers of road surfaces hold no areas ({names})</source>
            <translation>las capas de superficies de vía no tienen áreas ({names})</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>no layer of the project has the role road surface</source>
            <translation>ninguna capa del proyecto tiene el papel superficie de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>the road surfaces are being read</source>
            <translation>se están leyendo las superficies de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>this desk</source>
            <translation>esta consola</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n commands</source>
            <translation>
                <numerusform>%n orden</numerusform>
                <numerusform>%n órdenes</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n older commands came.</source>
            <translation>
                <numerusform>Ha llegado %n orden más antigua.</numerusform>
                <numerusform>Han llegado %n órdenes más antiguas.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n steps</source>
            <translation>
                <numerusform>%n paso</numerusform>
                <numerusform>%n pasos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>All commands</source>
            <translation>Todas las órdenes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>All robots</source>
            <translation>Todos los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Ask the gateway for older commands</source>
            <translation>Pedir a la pasarela órdenes más antiguas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Commands</source>
            <translation>Órdenes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Export commands</source>
            <translation>Exportar órdenes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Export…</source>
            <translation>Exportar…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Failed, aborted, expired</source>
            <translation>Fallidas, abortadas, caducadas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Go there</source>
            <translation>Ir allí</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>No older commands came.</source>
            <translation>No ha llegado ninguna orden más antigua.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>None open</source>
            <translation>Ninguna abierta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older</source>
            <translation>Más antiguas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older commands: the gateway has not answered for {seconds:g} s. Press Older to ask once more.</source>
            <translation>Órdenes más antiguas: la pasarela no ha respondido desde hace {seconds:g} s. Pulse Más antiguas para preguntarlo otra vez.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older commands: {why}</source>
            <translation>Órdenes más antiguas: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Open</source>
            <translation>Abiertas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Selected robots</source>
            <translation>Robots seleccionados</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Show where the chosen command leads to (double click)</source>
            <translation>Mostrar adónde lleva la orden elegida (doble clic)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>The gateway knows no others.</source>
            <translation>La pasarela no conoce ninguna otra.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>The log reaches no further back: the newest {asked} of each chosen robot, or of all, are asked for, and {kept} kept. Older ones are in the gateway's database.</source>
            <translation>El registro no llega más atrás: se piden las {asked} órdenes más recientes de cada robot elegido, o de todos, y se guardan {kept}. Las más antiguas están en la base de datos de la pasarela.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Which commands are listed</source>
            <translation>Qué órdenes se listan</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Whose commands are listed</source>
            <translation>De quién son las órdenes listadas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Write what is listed, every step of it, as CSV</source>
            <translation>Escribir lo listado, con todos sus pasos, como CSV</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>{commands} and {steps} written to {path}</source>
            <translation>se escribieron {commands} y {steps} en {path}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>{what} of {robot} leads to no place.</source>
            <translation>{what} de {robot} no lleva a ningún lugar.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>Details</source>
            <translation>Detalles</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>{metres:.2f} m off</source>
            <translation>{metres:.2f} m de desvío</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>{number} open: {counts}</source>
            <translation>{number} abiertas: {counts}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>&amp;Coordinates</source>
            <translation>&amp;Coordenadas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>A coordinate of what is selected is no number. Correct it, or leave it out.</source>
            <translation>Una coordenada de lo seleccionado no es un número. Corríjala u omítala.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>A route is one line, and {features} of the layer {layer} are meant: select one.</source>
            <translation>Una ruta es una línea, y hay {features} de la capa {layer}: seleccione una.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>C&amp;RS</source>
            <translation>S&amp;RC</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Coordinates</source>
            <translation>Coordenadas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Feature {id} of {layer} has no place in the site's CRS ({error}). Leave it out, or correct the layer's CRS.</source>
            <translation>El objeto {id} de {layer} no tiene lugar en el SRC del recinto ({error}). Omítalo, o corrija el SRC de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>No layer of points or lines is active. Click one in the Layers panel, then try again.</source>
            <translation>No hay ninguna capa de puntos o líneas activa. Haga clic en una en el panel Capas e inténtelo de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>No robot is selected. Select the one that the draft is for, then try again.</source>
            <translation>No hay ningún robot seleccionado. Seleccione aquel para quien es el borrador e inténtelo de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Set on the map</source>
            <translation>Poner en el mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has no CRS, so nobody knows where its points are. Set it in the layer's properties.</source>
            <translation>La capa {layer} no tiene SRC, así que nadie sabe dónde están sus puntos. Defínalo en las propiedades de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has no feature with a place to go to.</source>
            <translation>La capa {layer} no tiene ningún objeto con un lugar adonde ir.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has not answered for {seconds:g} s, so no draft was made of it. Bring its server or drive back and try again.</source>
            <translation>La capa {layer} no responde desde hace {seconds:g} s, así que no se ha hecho ningún borrador con ella. Restablezca su servidor o su unidad e inténtelo de nuevo.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has {count} features and a queue takes {longest_queue}: select those that are meant.</source>
            <translation>La capa {layer} tiene {count} objetos y una cola admite {longest_queue}: seleccione los que quiere.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has {places} points selected and a queue takes {longest_queue}: select fewer.</source>
            <translation>La capa {layer} tiene {places} puntos seleccionados y una cola admite {longest_queue}: seleccione menos.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} holds polygons: take a layer of points (targets) or lines (a route).</source>
            <translation>La capa {layer} contiene polígonos: tome una capa de puntos (objetivos) o líneas (una ruta).</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The line has {places} vertices; a route takes 2 to {longest_path}: simplify it first.</source>
            <translation>La línea tiene {places} vértices; una ruta admite de 2 a {longest_path}: simplifíquela antes.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The line that is selected in {layer} has {parts} parts, and a robot cannot leap from one to the next: make it one line.</source>
            <translation>La línea seleccionada en {layer} tiene {parts} partes, y un robot no puede saltar de una a otra: haga una sola línea.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Write {order} in {crs}.
{path}</source>
            <translation>Escriba {order} en {crs}.
{path}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>{site}; {east:.2f}, {north:.2f} in {crs}.
{path}</source>
            <translation>{site}; {east:.2f}, {north:.2f} en {crs}.
{path}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>{x:.2f}, {y:.2f} m on the site</source>
            <translation>{x:.2f}, {y:.2f} m en el recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Choose a conflict in the list first.</source>
            <translation>Elija primero un conflicto de la lista.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Give way</source>
            <translation>Ceder el paso</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>No robot is in another one's way.</source>
            <translation>Ningún robot está en el camino de otro.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Nobody can be sent aside: {why}</source>
            <translation>No se puede enviar a nadie a un lado: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Send aside</source>
            <translation>Apartar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Send {robot} aside</source>
            <translation>Apartar {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Stop</source>
            <translation>Detener</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Stop {robot}</source>
            <translation>Parar {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>at {x:.0f}, {y:.0f} m</source>
            <translation>en {x:.0f}, {y:.0f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>the gateway is being asked</source>
            <translation>se está preguntando a la pasarela</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>the gateway's answer cannot be read; it may be older than this plugin</source>
            <translation>la respuesta de la pasarela no se puede leer; puede que sea más antigua que este complemento</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} gives way</source>
            <translation>{robot} cede el paso</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} is paused: it stands, and keeps what it is doing for later</source>
            <translation>{robot} se pone en pausa: se para y guarda para más tarde lo que hace</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} waits for {other} or takes another way, whichever gets it there sooner</source>
            <translation>{robot} espera a {other} o toma otro recorrido, el que llegue antes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} waits for {other}, until {time_of_day} at the earliest</source>
            <translation>{robot} espera a {other}, como mínimo hasta las {time_of_day}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} × {other}: over</source>
            <translation>{robot} × {other}: terminado</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{text}; the route is shown first, and sent as any other</source>
            <translation>{text}; primero se muestra la ruta, y se envía como cualquier otra</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Gateway</source>
            <translation>&amp;Pasarela</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Keep under a name…</source>
            <translation>&amp;Guardar con un nombre…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Manage connections…</source>
            <translation>Ges&amp;tionar conexiones…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Access…</source>
            <translation>Acceso…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>CA file</source>
            <translation>Archivo de CA</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Certificates (*.pem *.crt *.cer);;All files (*)</source>
            <translation>Certificados (*.pem *.crt *.cer);;Todos los archivos (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connect</source>
            <translation>Conectar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connected</source>
            <translation>Conectado</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connecting</source>
            <translation>Conectando</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connection: {name}</source>
            <translation>Conexión: {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connections that are kept under a name</source>
            <translation>Conexiones guardadas con un nombre</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Disconnect</source>
            <translation>Desconectar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Encrypted, under the master password of the QGIS authentication manager</source>
            <translation>Cifrado, con la contraseña maestra del gestor de autenticación de QGIS</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Failed</source>
            <translation>Fallido</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Keep in QGIS</source>
            <translation>Guardar en QGIS</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Not connected</source>
            <translation>No conectado</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Retrying</source>
            <translation>Reintentando</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Retrying in {wait:.0f} s</source>
            <translation>Reintento en {wait:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>The site's ca.pem</source>
            <translation>El ca.pem del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Token and CA file, for a gateway with accounts and TLS</source>
            <translation>Testigo y archivo de CA, para una pasarela con cuentas y TLS</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Who you are: it stands beside every command in every log</source>
            <translation>Quién es usted: está junto a cada orden en todos los registros</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>fleet_op_…, as it was printed when the account was made</source>
            <translation>fleet_op_…, tal como se escribió al crear la cuenta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>kept by QGIS; enter another one to replace it</source>
            <translation>lo guarda QGIS; introduzca otro para cambiarlo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>of the connection's authentication; enter another one for this time</source>
            <translation>de la autenticación de la conexión; introduzca otro para esta vez</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>the site's ca.pem; empty for public authorities</source>
            <translation>el ca.pem del recinto; vacío para autoridades públicas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/dock.py" />
            <source>Queue</source>
            <translation>Cola</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source> since {time}</source>
            <translation> desde las {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Clear the emergency stop?</source>
            <translation>¿Levantar la parada de emergencia?</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Cleared, robots can be sent again. None sets off by itself: what they were doing was aborted.</source>
            <translation>Levantada, se pueden volver a enviar robots. Ninguno arranca solo: lo que hacían se abortó.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Clear…</source>
            <translation>Levantar…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>EMERGENCY STOP asked for. The gateway has not confirmed it yet: watch the robots, and use their own emergency stops.</source>
            <translation>PARADA DE EMERGENCIA pedida. La pasarela aún no la ha confirmado: vigile los robots y use sus propias paradas de emergencia.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>EMERGENCY STOP in force{since}, by {by}{reason}</source>
            <translation>PARADA DE EMERGENCIA en vigor{since}, por {by}{reason}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>In force at {reached} of {of} gateways</source>
            <translation>En vigor en {reached} de {of} pasarelas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Keep it in force</source>
            <translation>Mantenerla en vigor</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>MOVING: {names}</source>
            <translation>SE MUEVEN: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>NOT REACHED: gateways {names}. Watch their robots</source>
            <translation>NO SE HA LLEGADO a las pasarelas {names}. Vigile sus robots</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>No answer from {names}</source>
            <translation>Sin respuesta de {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Not heard now, may move: {names}</source>
            <translation>Ahora no se sabe nada de ellos, pueden moverse: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Not stored yet: the gateway cannot write its database, so robots on SQL are not told.</source>
            <translation>Aún no se ha guardado: la pasarela no puede escribir su base de datos, así que los robots por SQL no se enteran.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>REFUSED by {names}</source>
            <translation>RECHAZADA por {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>The gateway has said nothing for {seconds} s: robots may move. It said last:</source>
            <translation>Hace {seconds} s que la pasarela no dice nada: los robots pueden moverse. Lo último que dijo:</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Why robots may drive again, for the log</source>
            <translation>Por qué los robots pueden volver a circular, para el registro</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/emergency.py" />
            <source>{acknowledged} of %n robots acknowledged, {standing} seen to stand</source>
            <translation>
                <numerusform>{acknowledged} de %n robot lo confirmó, {standing} se ve parado</numerusform>
                <numerusform>{acknowledged} de %n robots lo confirmaron, {standing} se ven parados</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source> Override… sends it all the same, where your role may.</source>
            <translation> Imponer… lo envía de todos modos, donde su papel lo permita.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Map for {robot}</source>
            <translation>Mapa para {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>No robot is selected, so none was sent the map. Select it first.</source>
            <translation>No hay ningún robot seleccionado, así que a ninguno se le envió el mapa. Selecciónelo antes.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Nothing is sent yet.</source>
            <translation>Aún no se envía nada.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Override</source>
            <translation>Imponer</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Override the checks</source>
            <translation>Imponerse a las comprobaciones</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Select a robot, choose Cone target or Draw route, and click on the map.</source>
            <translation>Seleccione un robot, elija Objetivo de cono o Dibujar ruta, y haga clic en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>The draft has changed since it was looked at, so nothing was overridden. Press Override again.</source>
            <translation>El borrador ha cambiado desde que se miró, así que no se impuso nada. Pulse Imponer otra vez.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>There is no draft on the map. Select a robot, then set a cone target or draw a route.</source>
            <translation>No hay ningún borrador en el mapa. Seleccione un robot, y ponga un objetivo de cono o dibuje una ruta.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Why it is right all the same</source>
            <translation>Por qué es correcto de todos modos</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Your name, what was found and why go into the gateway's log.</source>
            <translation>Su nombre, lo hallado y el porqué van al registro de la pasarela.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>because: {reason}</source>
            <translation>porque: {reason}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words} is being checked: {share:.0%}. It goes out when nothing speaks against it.</source>
            <translation>{in_words} se está comprobando: {share:.0%}. Saldrá si nada habla en contra.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words} was not put into the queue: {fault}</source>
            <translation>{in_words} no se puso en la cola: {fault}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}, into the queue</source>
            <translation>{in_words}, a la cola</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Being checked: {share:.0%}.</source>
            <translation>{in_words}. Se está comprobando: {share:.0%}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Being checked: {share:.0%}. It goes out when nothing speaks against it; Esc keeps it back.</source>
            <translation>{in_words}. Se está comprobando: {share:.0%}. Se enviará si nada lo desaconseja; Esc lo detiene.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. It goes out when that is found and nothing speaks against it; Esc keeps it back.</source>
            <translation>{in_words}. Se enviará cuando se haya encontrado el camino y si nada lo desaconseja; Esc lo detiene.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Not to be sent: {found}{hint}</source>
            <translation>{in_words}. No se puede enviar: {found}{hint}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. OVERRIDDEN: {override}. Enter or Send sends it.</source>
            <translation>{in_words}. IMPUESTO: {override}. Intro o Enviar lo envía.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}.{warnings} Add to queue lets them be placed one after the other.</source>
            <translation>{in_words}.{warnings} Añadir a la cola hace que se coloquen uno tras otro.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}.{warnings} Enter or Send sends it.</source>
            <translation>{in_words}.{warnings} Intro o Enviar lo envía.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}: there is nothing here that an override would help.</source>
            <translation>{in_words}: aquí no hay nada en lo que ayude imponerse.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>A task of {robot} first</source>
            <translation>Una tarea de {robot} primero</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Continue for {robot}</source>
            <translation>Continuar para {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Do now</source>
            <translation>Hacer ahora</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Let the robot do the selected task at once; what it is doing comes next (Ctrl+Enter)</source>
            <translation>Que el robot haga la tarea seleccionada al instante; lo que hace viene después (Ctrl+Intro)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Let the robot go on with the task at the head of its queue</source>
            <translation>Dejar que el robot siga con la primera tarea de su cola</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Move the selected task one down (Alt+Down)</source>
            <translation>Mover la tarea seleccionada un lugar abajo (Alt+Abajo)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Move the selected task one up (Alt+Up)</source>
            <translation>Mover la tarea seleccionada un lugar arriba (Alt+Arriba)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Moving a task of {robot}</source>
            <translation>Mover una tarea de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>No robot is selected, so none was paused. Select it in the table or on the map.</source>
            <translation>No hay ningún robot seleccionado, así que no se pausó ninguno. Selecciónelo en la tabla o en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Not done: the queue has changed since you saw it. This is how it stands now.</source>
            <translation>No se hizo: la cola ha cambiado desde que la vio. Ahora está así.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Pause</source>
            <translation>Pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Pausing the queue of {robot}</source>
            <translation>Pausar la cola de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Removing a task of {robot}</source>
            <translation>Quitar una tarea de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Resume</source>
            <translation>Reanudar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Resuming the queue of {robot}</source>
            <translation>Reanudar la cola de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Select a robot to see its queue. None has one yet.</source>
            <translation>Seleccione un robot para ver su cola. Ninguno tiene aún.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Select a robot to see its queue. {queues} have one, {paused} of them paused.</source>
            <translation>Seleccione un robot para ver su cola. {queues} tienen una, {paused} en pausa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Send the robot no further task; what it is doing it finishes (Pause robot stops it)</source>
            <translation>No enviar más tareas al robot; termina lo que está haciendo (Pausar robot lo detiene)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Take the selected task out (Delete)</source>
            <translation>Quitar la tarea seleccionada (Supr)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Task</source>
            <translation>Tarea</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The gateway has not answered yet what was asked of the queue of {robot} before. Try again in a moment.</source>
            <translation>La pasarela aún no ha respondido a lo que se pidió antes de la cola de {robot}. Inténtelo de nuevo en un momento.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The link was lost before the answer, and the queue has changed, perhaps by this. So it stands now.</source>
            <translation>El enlace se perdió antes de la respuesta, y la cola ha cambiado, quizá por esto. Ahora está así.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The queue of {robot} was paused just before the click, so it was not resumed. Press Resume again to let it continue.</source>
            <translation>La cola de {robot} se puso en pausa justo antes del clic, así que no se ha reanudado. Pulse Reanudar otra vez para que continúe.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>added by {by}</source>
            <translation>añadida por {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>waiting: robot</source>
            <translation>en espera: robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{robot} continues</source>
            <translation>{robot} continúa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{robot} continues with {task}</source>
            <translation>{robot} continúa con {task}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{selected} has no queue. Add a target or a route with Add to queue.</source>
            <translation>{selected} no tiene cola. Añada un objetivo o una ruta con Añadir a la cola.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>, {metres:.2f} m off</source>
            <translation>, {metres:.2f} m de desvío</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Ask again</source>
            <translation>Pedir otra vez</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Ask for the robot's last image and its commands again</source>
            <translation>Pedir otra vez la última imagen y las órdenes del robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Diagnostics as received</source>
            <translation>Diagnóstico tal como llegó</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>It says</source>
            <translation>Dice</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>No image: {why}</source>
            <translation>Ninguna imagen: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Now</source>
            <translation>Ahora</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Off path or target</source>
            <translation>Desvío del camino o del objetivo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Position, {crs}</source>
            <translation>Posición, {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Reading a robot's image</source>
            <translation>Leyendo la imagen de un robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Select a robot in the table or on the map</source>
            <translation>Seleccione un robot en la tabla o en el mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>The image that came cannot be read: it is none of a kind that QGIS knows.</source>
            <translation>La imagen que llegó no se puede leer: no es de ningún tipo que QGIS conozca.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Why elsewhere</source>
            <translation>Por qué en otro lugar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>and {more} more</source>
            <translation>y {more} más</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>looking for an image …</source>
            <translation>buscando una imagen …</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>the image is coming …</source>
            <translation>llega la imagen …</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{command}, by {operator}</source>
            <translation>{command}, por {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{robot} has sent no image lately</source>
            <translation>{robot} no ha enviado ninguna imagen últimamente</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{robot}, selected last of several</source>
            <translation>{robot}, el último seleccionado de varios</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Age</source>
            <translation>Edad</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Batt.</source>
            <translation>Bat.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How far it is beside its path, or from the target that it reached last</source>
            <translation>A qué distancia está de su camino, o del último objetivo alcanzado</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How far what is known of it can be trusted</source>
            <translation>Hasta qué punto se puede confiar en lo que se sabe de él</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How full its battery is</source>
            <translation>Cómo de llena tiene la batería</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How it is connected; @ and a name: at another gateway</source>
            <translation>Cómo está conectado; @ y un nombre: en otra pasarela</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How long ago anything was heard of it</source>
            <translation>Cuánto hace que se supo algo de él</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How long its link takes there and back</source>
            <translation>Cuánto tarda su enlace en ir y volver</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Its speed, as it says</source>
            <translation>Su velocidad, según dice</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Off</source>
            <translation>Desv.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Ping</source>
            <translation>Ping</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Position</source>
            <translation>Posición</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Speed</source>
            <translation>Velocidad</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>The robot's name</source>
            <translation>El nombre del robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>What it is doing, or what it says</source>
            <translation>Qué hace, o qué dice</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Where it is, in the CRS chosen under Columns</source>
            <translation>Dónde está, en el SRC elegido en Columnas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>at {x:.2f}, {y:.2f} m in the site frame</source>
            <translation>en {x:.2f}, {y:.2f} m en el marco del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>cone</source>
            <translation>cono</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>it says: {text}</source>
            <translation>dice: {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>its link takes {ms:.1f} ms there and back</source>
            <translation>su enlace tarda {ms:.1f} ms en ir y volver</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>on route</source>
            <translation>en ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>paused</source>
            <translation>en pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>route</source>
            <translation>ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>stopped</source>
            <translation>parado</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>target</source>
            <translation>objetivo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>to cone</source>
            <translation>al cono</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>to target</source>
            <translation>al objetivo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Another CRS…</source>
            <translation>Otro SRC…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>CRS of the project ({crs})</source>
            <translation>SRC del proyecto ({crs})</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Columns</source>
            <translation>Columnas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Latitude, longitude (WGS 84)</source>
            <translation>Latitud, longitud (WGS 84)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Name, state, task or link; several words have to be there all</source>
            <translation>Nombre, estado, tarea o enlace; si hay varias palabras deben estar todas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Positions in: {crs}</source>
            <translation>Posiciones en: {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Search</source>
            <translation>Buscar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Search robots</source>
            <translation>Buscar robots</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Site frame (metres)</source>
            <translation>Marco del recinto (metros)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>The search finds others by name.</source>
            <translation>La búsqueda encuentra los demás por su nombre.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Which columns are shown, and in which CRS positions are</source>
            <translation>Qué columnas se muestran, y en qué SRC están las posiciones</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>With a task</source>
            <translation>Con tarea</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>With alarms, or not fresh</source>
            <translation>Con alarmas, o no frescos</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Without a task</source>
            <translation>Sin tarea</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>no such place</source>
            <translation>ningún lugar así</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>{listed} of {all}</source>
            <translation>{listed} de {all}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source> Without a role, since other layers of the project have it: {layers}. Plugins &gt; Fleet Supervisor &gt; Layer roles changes that.</source>
            <translation> Sin papel, porque lo tienen otras capas del proyecto: {layers}. Complementos &gt; Fleet Supervisor &gt; Papeles de las capas lo cambia.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Closed before the gateway answered, so it may be done or not: {asked}</source>
            <translation>Se cerró antes de que la pasarela respondiera, así que puede estar hecho o no: {asked}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>No emergency stop is in force.</source>
            <translation>No hay ninguna parada de emergencia en vigor.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Quit all the same</source>
            <translation>Salir de todos modos</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Quit before the gateway has answered?</source>
            <translation>¿Salir antes de que la pasarela responda?</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Stay</source>
            <translation>Quedarse</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Targets and routes</source>
            <translation>Objetivos y rutas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>The gateway has not answered yet: {asked}. Who quits now does not learn whether it is done, and what is not sent yet never is.</source>
            <translation>La pasarela todavía no ha respondido: {asked}. Quien sale ahora no sabrá si se hace, y lo que aún no se ha enviado no se enviará nunca.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>The site in {folder} is in the project already: {names}.</source>
            <translation>El recinto de {folder} ya está en el proyecto: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>This project is not that of site {site}: its variables have another origin, CRS or rotation. Checks and alarms go by the layers of this project: open the site's.</source>
            <translation>Este proyecto no es el del recinto {site}: sus variables tienen otro origen, SRC o rotación. Las comprobaciones y las alarmas siguen las capas de este proyecto: abra el del recinto.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/window.py" />
            <source>{site}: %n layers loaded.</source>
            <translation>
                <numerusform>{site}: %n capa cargada.</numerusform>
                <numerusform>{site}: %n capas cargadas.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>%n cones</source>
            <translation>
                <numerusform>%n cono</numerusform>
                <numerusform>%n conos</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>%n cones placed</source>
            <translation>
                <numerusform>%n cono colocado</numerusform>
                <numerusform>%n conos colocados</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>, {collected} collected again</source>
            <translation>, {collected} recogidos de nuevo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>As-placed report</source>
            <translation>Informe de colocación</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Collected</source>
            <translation>Recogido</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Cone</source>
            <translation>Cono</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Figures, histogram, map and table of these cones as a PDF</source>
            <translation>Cifras, histograma, mapa y tabla de estos conos en un PDF</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>No cone was put down yet.</source>
            <translation>Aún no se ha dejado ningún cono.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Off [m]</source>
            <translation>Desvío [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Placed</source>
            <translation>Colocado</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Plan collecting</source>
            <translation>Planificar la recogida</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Planned x, y</source>
            <translation>x, y previstas</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Refresh</source>
            <translation>Actualizar</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Report…</source>
            <translation>Informe…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Save as CSV…</source>
            <translation>Guardar como CSV…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Stands at x, y</source>
            <translation>Está en x, y</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>The report is made by QGIS's Processing: switch that on in Plugins &gt; Manage and Install Plugins.</source>
            <translation>El informe lo hace Procesos de QGIS: actívelo en Complementos &gt; Administrar e instalar complementos.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>everything</source>
            <translation>todo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>layout {name}</source>
            <translation>disposición {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>off by {mean:.3f} m on average, at most {largest:.3f} m</source>
            <translation>desvío medio de {mean:.3f} m, como máximo {largest:.3f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>the plan that is driven</source>
            <translation>el plan que se ejecuta</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{cones} of %n cones placed</source>
            <translation>
                <numerusform>{cones} de %n cono colocado</numerusform>
                <numerusform>{cones} de %n conos colocados</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{cones} written to {path}</source>
            <translation>se ha escrito en {path}: {cones}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{placed}{gone}; {off}</source>
            <translation>{placed}{gone}; {off}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>A new plan was sent by itself, as was switched on: {why}</source>
            <translation>Se ha enviado un plan nuevo por sí solo, como estaba activado: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>A plan is being driven. Plan what is left, choose New plan to plan for other robots, or press Clear: nobody follows it then, and robots go on with their queues.</source>
            <translation>Se está ejecutando un plan. Planifique lo que queda, elija Plan nuevo para planificar para otros robots, o pulse Limpiar: entonces nadie lo sigue y los robots continúan con sus colas.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Clearing the cone plan</source>
            <translation>Borrado del plan de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Going on as before</source>
            <translation>Continuación como antes</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Going on with the cone plan</source>
            <translation>Continuación del plan de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>No new cone plan was sent by itself: {why}.</source>
            <translation>No se ha enviado por sí solo ningún plan de conos nuevo: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>No plan is being driven, or something is still being sent.</source>
            <translation>No se ejecuta ningún plan, o aún se está enviando algo.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Nothing was overridden: what was refused is no longer being sent. Look at the plan.</source>
            <translation>No se impuso nada: lo que se rechazó ya no se está enviando. Mire el plan.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Pause of the cone plan</source>
            <translation>Pausa del plan de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Paused: {robots} ({why})</source>
            <translation>En pausa: {robots} ({why})</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Plan of what is left</source>
            <translation>Plan de lo que queda</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Sending the cone plan</source>
            <translation>Envío del plan de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan cannot go on as it is: {why}. Plan what is left.</source>
            <translation>El plan de conos no puede seguir como está: {why}. Planifique lo que queda.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan is in the robots' queues.</source>
            <translation>El plan de conos está en las colas de los robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan is paused: {why}.</source>
            <translation>El plan de conos está en pausa: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan was not sent. {words}: {found} Override… in the panel Cone plan sends it all the same, where your role may.</source>
            <translation>El plan de conos no se ha enviado. {words}: {found} Imponer… en el panel Plan de conos lo envía de todos modos, donde su papel lo permita.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The gateway is older than this plugin and drives no cone plans: plans are made and looked at here, and nothing of them is sent. Update the gateway, or give robots their cones with Add to queue.</source>
            <translation>La pasarela es más antigua que este complemento y no ejecuta planes de conos: aquí se hacen y se miran planes, y no se envía nada de ellos. Actualice la pasarela, o dé los conos a los robots con Añadir a la cola.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The new cone plan</source>
            <translation>El plan de conos nuevo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The plan cannot be sent: {error}</source>
            <translation>El plan no se puede enviar: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>There is no new plan to confirm.</source>
            <translation>No hay ningún plan nuevo que confirmar.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>There is no plan to send. Make one with Preview or Solve first.</source>
            <translation>No hay ningún plan que enviar. Haga uno antes con Vista previa o Resolver.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>{by} cleared the cone plan: nobody follows it any more, and robots go on with their queues.</source>
            <translation>{by} ha borrado el plan de conos: ya nadie lo sigue, y los robots continúan con sus colas.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>A cone takes</source>
            <translation>Un cono tarda</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Aboard</source>
            <translation>A bordo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Aboard: cones on the robot now. Range: metres of battery, 0 if it does not matter</source>
            <translation>A bordo: conos en el robot ahora. Alcance: metros de batería, 0 si no importa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>At the end</source>
            <translation>Al final</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Carries</source>
            <translation>Lleva</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Cones</source>
            <translation>Conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>How it is planned</source>
            <translation>Cómo se planifica</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Least</source>
            <translation>Mínimo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Off cones by</source>
            <translation>Lejos de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Off robots by</source>
            <translation>Lejos de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Only the features of the layer that are selected</source>
            <translation>Solo los objetos seleccionados de la capa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Range</source>
            <translation>Alcance</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Robots that come nearer to one another by the plan are named</source>
            <translation>Se nombran los robots que según el plan se acercan más</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Solve for at most</source>
            <translation>Resolver como máximo en</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Stores</source>
            <translation>Almacenes</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Straight within</source>
            <translation>Recto dentro de</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>The layers of the project with the role road centreline</source>
            <translation>Las capas del proyecto con el papel eje de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Ways are led round cones by so much</source>
            <translation>Los recorridos rodean los conos a esta distancia</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>along the roads of the project</source>
            <translation>por las vías del proyecto</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>choose a layer of points</source>
            <translation>elija una capa de puntos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>m/s</source>
            <translation>m/s</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>selected</source>
            <translation>seleccionados</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>{column} of {robot} is {text!r}: give {least:g} or more.</source>
            <translation>{column} de {robot} es {text!r}: dé {least:g} o más.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>{name} is away: it takes no part</source>
            <translation>{name} no está: no participa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Degrees clockwise from north; the wheel over the map turns it too</source>
            <translation>Grados en sentido horario desde el norte; la rueda sobre el mapa también la gira</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Heading</source>
            <translation>Rumbo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Remove the cones that were placed last; Ctrl+Z over the map does so too</source>
            <translation>Quita los conos colocados en último lugar; Ctrl+Z sobre el mapa también lo hace</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Reset to the standard</source>
            <translation>Restablecer la norma</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Standard: {value}</source>
            <translation>Norma: {value}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Take back the last layout</source>
            <translation>Retirar la última disposición</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>too many cones; a plan has {most} at most</source>
            <translation>demasiados conos; un plan tiene {most} como máximo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The cones of the layer {layer} are not saved with the project: {problem}. Export the layer to a file before you close QGIS.</source>
            <translation>Los conos de la capa {layer} no se han guardado con el proyecto: {problem}. Exporte la capa a un archivo antes de cerrar QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer of cones is another one now: place the layout again.</source>
            <translation>La capa de conos ahora es otra: coloque de nuevo la disposición.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer {layer} takes no cones without the fields {fields}: add them, or remove the layer.</source>
            <translation>La capa {layer} no admite conos sin los campos {fields}: añádalos, o quite la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer {layer} takes no cones: make it writable, or remove it.</source>
            <translation>La capa {layer} no admite conos: hágala editable, o quítela.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The project has no CRS: choose one in metres, at the bottom right in QGIS.</source>
            <translation>El proyecto no tiene SRC: elija uno en metros, abajo a la derecha en QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>the project is not a file</source>
            <translation>el proyecto no es un archivo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>{path} cannot be read again</source>
            <translation>{path} no se puede volver a leer</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>{path} cannot be written ({words})</source>
            <translation>{path} no se puede escribir ({words})</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>%n cones are in the layer {layer}.</source>
            <translation>
                <numerusform>%n cono está en la capa {layer}.</numerusform>
                <numerusform>%n conos están en la capa {layer}.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>Place a cone layout: it is shown under the cursor, the wheel turns it, with Shift finely, a click places it, Ctrl+Z takes it back, Esc ends; by keys PgUp and PgDown turn it, Enter places it, F2 leads to its dimensions. Nothing is sent to robots</source>
            <translation>Coloca una disposición de conos: se muestra bajo el cursor, la rueda la gira, con Mayús con precisión, un clic la coloca, Ctrl+Z la retira, Esc termina; con teclas, RePág y AvPág la giran, Intro la coloca, F2 lleva a sus dimensiones. No se envía nada a los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>Place cone layout</source>
            <translation>Colocar disposición de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>The cones in the layer {layer} were not checked: {why}</source>
            <translation>Los conos de la capa {layer} no se han comprobado: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>layers of road surfaces and obstacles have not been read within {seconds:g} s</source>
            <translation>las capas de superficies de vía y de obstáculos no se han leído en {seconds:g} s</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>{wrong} of %n cones should not stand there: {text} All are in the layer {layer}.</source>
            <translation>
                <numerusform>{wrong} de %n cono no debería estar ahí: {text} Está en la capa {layer}.</numerusform>
                <numerusform>{wrong} de %n conos no deberían estar ahí: {text} Todos están en la capa {layer}.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>%n ways lead along closed roads</source>
            <translation>
                <numerusform>%n camino pasa por vías cerradas</numerusform>
                <numerusform>%n caminos pasan por vías cerradas</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A good plan, within the time that is given</source>
            <translation>Un buen plan, dentro del tiempo dado</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A new plan, or one that the gateway drives, whoever submitted it</source>
            <translation>Un plan nuevo, o uno que ejecuta la pasarela, lo haya enviado quien sea</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A quick plan, to look at</source>
            <translation>Un plan rápido, para mirarlo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>As placed</source>
            <translation>Como se colocó</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Being sent …</source>
            <translation>Enviando …</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Clear</source>
            <translation>Limpiar</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Cone plan</source>
            <translation>Plan de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Confirm new plan</source>
            <translation>Confirmar plan nuevo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Do not send</source>
            <translation>No enviar</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Done: {done} of %n cones</source>
            <translation>
                <numerusform>Hecho: {done} de %n cono</numerusform>
                <numerusform>Hecho: {done} de %n conos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Follow the plan no more, at no desk; robots go on with their queues</source>
            <translation>Deja de seguir el plan en todas las consolas; los robots continúan con sus colas</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Give up what is being planned</source>
            <translation>Abandonar lo que se está planificando</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Go on as before</source>
            <translation>Seguir como antes</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Hold the robots once they have finished what they are doing, and plan what is left; nothing else is sent before you confirm</source>
            <translation>Retener los robots cuando acaben lo que hacen, y planificar lo que queda; no se envía nada más hasta que lo confirme</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Let them go on</source>
            <translation>Que continúen</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>New plan</source>
            <translation>Plan nuevo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>New plan, not sent yet: {summary}</source>
            <translation>Plan nuevo, aún no enviado: {summary}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>No plan. Choose cones and robots, then Preview or Solve.</source>
            <translation>Ningún plan. Elija conos y robots, y después Vista previa o Resolver.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Not sent yet: {summary}</source>
            <translation>Aún no enviado: {summary}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Override…</source>
            <translation>Imponer…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Pause the plan</source>
            <translation>Pausar el plan</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Placed cones</source>
            <translation>Conos colocados</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan</source>
            <translation>Plan</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan what is left</source>
            <translation>Planificar lo que queda</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan which robot places or collects which cone, send it, watch it; the as-placed report</source>
            <translation>Planificar qué robot coloca o recoge qué cono, enviarlo y seguirlo; el informe de colocación</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Preview</source>
            <translation>Vista previa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Resume the queues of the plan's robots that somebody paused</source>
            <translation>Reanuda las colas de los robots del plan que alguien puso en pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send</source>
            <translation>Enviar</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send new plans without asking</source>
            <translation>Enviar planes nuevos sin preguntar</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the cone plan</source>
            <translation>Enviar el plan de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the plan in spite of what was found; asks why</source>
            <translation>Envía el plan a pesar de lo encontrado; pregunta el motivo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the plan's robots no further task; what they are doing they finish</source>
            <translation>No se envía ninguna tarea más a los robots del plan; terminan lo que están haciendo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send…</source>
            <translation>Enviar…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Solve</source>
            <translation>Resolver</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>The plan is sent at once, and robots set off.</source>
            <translation>El plan se envía enseguida, y los robots se ponen en marcha.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Under way: {done} of %n cones</source>
            <translation>
                <numerusform>En curso: {done} de %n cono</numerusform>
                <numerusform>En curso: {done} de %n conos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>What is left is being planned …</source>
            <translation>Se está planificando lo que queda …</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>When a robot is lost or a cone fails, plan what is left and send it by itself</source>
            <translation>Cuando se pierde un robot o falla un cono, planifica lo que queda y lo envía solo</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>robots come too near to one another at %n places</source>
            <translation>
                <numerusform>los robots se acercan demasiado entre sí en %n lugar</numerusform>
                <numerusform>los robots se acercan demasiado entre sí en %n lugares</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>try failed cones again</source>
            <translation>reintentar los conos fallidos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>; {queued} are in queues already</source>
            <translation>; {queued} ya están en colas</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>A plan is being made. Wait for it, or press Cancel.</source>
            <translation>Se está haciendo un plan. Espérelo, o pulse Cancelar.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Change of the cone plan</source>
            <translation>Cambio del plan de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Collecting cannot be planned: {error}</source>
            <translation>No se puede planificar la recogida: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone of layout {layout} stands that could be collected{also}.</source>
            <translation>No hay ningún cono de la disposición {layout} que se pueda recoger{also}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone of this plan stands that could be collected: none was placed, or they are collected or in queues already. For others choose a layout, or everything.</source>
            <translation>No hay ningún cono de este plan en pie que se pueda recoger: no se colocó ninguno, o ya se recogieron o están en colas. Para otros elija una disposición, o todo.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone stands that could be collected{also}.</source>
            <translation>No hay ningún cono que se pueda recoger{also}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No robot that is there is chosen: tick robots in the table, or connect some.</source>
            <translation>No se ha elegido ningún robot presente: marque robots en la tabla, o conecte alguno.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Others take no part in the plan.</source>
            <translation>Los demás no participan en el plan.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Preview of the cone plan</source>
            <translation>Vista previa del plan de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>There is no store where robots load or unload cones: choose a layer of points under Stores, or write under Aboard how many cones each robot has to place.</source>
            <translation>No hay ningún almacén donde los robots carguen o descarguen conos: elija una capa de puntos en Almacenes, o escriba en A bordo cuántos conos por colocar lleva cada robot.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>What is to be collected</source>
            <translation>Qué hay que recoger</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>No layer of cones is chosen. Choose one, or place a cone layout first.</source>
            <translation>No se ha elegido ninguna capa de conos. Elija una, o coloque antes una disposición de conos.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>The layer of stores is not in the project any more. Choose another, or none.</source>
            <translation>La capa de almacenes ya no está en el proyecto. Elija otra, o ninguna.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>The layer {layer} has {which}: there is nothing to be placed.</source>
            <translation>La capa {layer} tiene {which}: no hay nada que colocar.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>no features</source>
            <translation>ningún objeto</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>no selected features</source>
            <translation>ningún objeto seleccionado</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>%n robots</source>
            <translation>
                <numerusform>%n robot</numerusform>
                <numerusform>%n robots</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>%n tasks that wait in the queue of {id} are replaced</source>
            <translation>
                <numerusform>se sustituye %n tarea que espera en la cola de {id}</numerusform>
                <numerusform>se sustituyen %n tareas que esperan en la cola de {id}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>FAILED</source>
            <translation>FALLÓ</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>Found by: {method}. Ways along: {travel}.</source>
            <translation>Método: {method}. Los caminos siguen: {travel}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>Mind:</source>
            <translation>Atención:</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>The queue of {robot} stays paused ({reason}): its cones wait until it is resumed.</source>
            <translation>La cola de {robot} sigue en pausa ({reason}): sus conos esperan a que se reanude.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>The robots set off at once.</source>
            <translation>Los robots arrancan al instante.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>cone {cone} failed{why}</source>
            <translation>el cono {cone} falló{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>in the queue</source>
            <translation>en la cola</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>it is not known where {id} is</source>
            <translation>no se sabe dónde está {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>no reason</source>
            <translation>ningún motivo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>straight lines</source>
            <translation>líneas rectas</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>taken out</source>
            <translation>quitado</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the queue of {id} is paused ({reason}): it is resumed</source>
            <translation>la cola de {id} está en pausa ({reason}): se reanuda</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the roads</source>
            <translation>las vías</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the way of {robot} to {stop} leads along a closed road{why}</source>
            <translation>el camino de {robot} a {stop} pasa por una vía cerrada{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>under way</source>
            <translation>en curso</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{by}, {time}: {robots}</source>
            <translation>{by}, {time}: {robots}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{cones}, {robots}, {metres:.0f} m, done after {span} ({method}, along {travel})</source>
            <translation>{cones}, {robots}, {metres:.0f} m, hecho en {span} ({method}, por {travel})</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} finishes first what it is doing</source>
            <translation>{id} acaba antes lo que hace</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} is {away:.1f} m from where the plan begins: better plan anew</source>
            <translation>{id} está a {away:.1f} m de donde empieza el plan: mejor planificar de nuevo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} is {state}: it gets its queue when it is heard of again</source>
            <translation>{id} está {state}: recibe su cola cuando se vuelva a saber de él</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{robot} is lost or offline</source>
            <translation>{robot} está perdido o sin conexión</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{text}. Left out: {names}</source>
            <translation>{text}. Fuera: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Arrives</source>
            <translation>Llega</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cone plan, stops</source>
            <translation>Plan de conos, paradas</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cone plan, ways</source>
            <translation>Plan de conos, recorridos</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cones as placed</source>
            <translation>Conos tal como se colocaron</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Drag a cone to another place or robot; Alt+Up and Alt+Down move it, Del takes it out</source>
            <translation>Arrastre un cono a otro lugar o robot; Alt+Arriba y Alt+Abajo lo mueven, Supr lo quita</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Give to {name}</source>
            <translation>Dar a {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>LOST, {text}</source>
            <translation>PERDIDO, {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Robot, stop</source>
            <translation>Robot, parada</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Take out</source>
            <translation>Quitar</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>collect </source>
            <translation>recoger </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>end at </source>
            <translation>fin en </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>store </source>
            <translation>almacén </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_views.py" />
            <source>{done} of %n cones</source>
            <translation>
                <numerusform>{done} de %n cono</numerusform>
                <numerusform>{done} de %n conos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>The assignment was cancelled.</source>
            <translation>Se canceló la asignación.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>The plan could not be made. Please report this:
{traceback}</source>
            <translation>El plan no se pudo hacer. Comunique esto:
{traceback}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>the way of {robot} to {stop} leads along a road that {by} closed{why}</source>
            <translation>el camino de {robot} a {stop} pasa por una vía que {by} cerró{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>{name}, straight within {nearby:g} m</source>
            <translation>{name}, recto dentro de {nearby:g} m</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>{robot} and {other} come within {metres:.1f} m at {x:.0f}, {y:.0f} m after {minutes}:{seconds:02d}</source>
            <translation>{robot} y {other} se acercan a {metres:.1f} m en {x:.0f}, {y:.0f} m al cabo de {minutes}:{seconds:02d}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>%n features have no planned or no placed position; they are left out.</source>
            <translation>
                <numerusform>%n objeto espacial no tiene posición planificada o colocada; queda fuera.</numerusform>
                <numerusform>%n objetos espaciales no tienen posición planificada o colocada; quedan fuera.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>95 % deviate at most [m]</source>
            <translation>El 95 % se desvía como máximo [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>&lt;p&gt;Compares where cones stand with where they were to stand, and writes a PDF: how many are within the tolerance, a histogram of the deviations, a map and a table of every cone, worst first.&lt;/p&gt; &lt;p&gt;The cones are a layer of the GeoPackage that &lt;i&gt;robot-bridge placements export cones.gpkg --site site&lt;/i&gt; writes, or its CSV; for a CSV, which has none, give the site's CRS. A cone stands where the robot was when it had reached its target, and from there the site's cone offset: the gateway's knowledge, no survey.&lt;/p&gt; &lt;p&gt;On the map a cross is the plan and a circle the cone, red where it is beyond the tolerance. Deviations are small: the lines from the crosses are longer than they are by the factor that the map names. Give background layers, such as roads, to be drawn beneath.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:asplacedreport -- INPUT="cones.gpkg|layername=placed" TOLERANCE=0.2 OUTPUT=report.pdf&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Compara dónde están los conos con dónde debían estar, y escribe un PDF: cuántos están dentro de la tolerancia, un histograma de las desviaciones, un mapa y una tabla de todos los conos, primero el peor.&lt;/p&gt; &lt;p&gt;Los conos son una capa del GeoPackage que escribe &lt;i&gt;robot-bridge placements export cones.gpkg --site site&lt;/i&gt;, o su CSV; para un CSV, que no lo tiene, dé el SRC del recinto. Un cono está donde estaba el robot cuando llegó a su objetivo, y desde allí el desplazamiento del cono del recinto: es lo que sabe la pasarela, no un levantamiento topográfico.&lt;/p&gt; &lt;p&gt;En el mapa una cruz es el plan y un círculo el cono, rojo cuando está fuera de la tolerancia. Las desviaciones son pequeñas: las líneas desde las cruces son más largas por el factor que dice el mapa. Dé capas de fondo, como vías, para dibujarlas debajo.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:asplacedreport -- INPUT="cones.gpkg|layername=placed" TOLERANCE=0.2 OUTPUT=report.pdf&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Background of the map</source>
            <translation>Fondo del mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Cones as placed and as planned</source>
            <translation>Conos colocados y planificados</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Cones within the tolerance</source>
            <translation>Conos dentro de la tolerancia</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>It is written: {link}</source>
            <translation>Se ha escrito: {link}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Largest deviation [m]</source>
            <translation>Mayor desviación [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Mean deviation [m]</source>
            <translation>Desviación media [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>PDF files (*.pdf)</source>
            <translation>Archivos PDF (*.pdf)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Pages</source>
            <translation>Páginas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Records</source>
            <translation>Registros</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Report</source>
            <translation>Informe</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Root mean square deviation [m]</source>
            <translation>Desviación media cuadrática [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Site CRS (default: the layer's)</source>
            <translation>SRC del recinto (por defecto: el de la capa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>The CRS of the placed cones is not known, as of a CSV: give CRS, the site's, such as EPSG:32633.</source>
            <translation>No se conoce el SRC de los conos colocados, como en un CSV: dé CRS, el del recinto, como EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Title</source>
            <translation>Título</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Tolerance [m]</source>
            <translation>Tolerancia [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Warnings</source>
            <translation>Avisos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Writes a PDF of how placed cones stand against their plan: figures, histogram, map and table.</source>
            <translation>Escribe un PDF de cómo están los conos colocados respecto al plan: cifras, histograma, mapa y tabla.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>{within} of %n cones are within {tolerance:g} m; the worst is {most:.3f} m off.</source>
            <translation>
                <numerusform>{within} de %n cono está dentro de {tolerance:g} m; se desvía {most:.3f} m.</numerusform>
                <numerusform>{within} de %n conos están dentro de {tolerance:g} m; el peor se desvía {most:.3f} m.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>%n trips</source>
            <translation>
                <numerusform>%n viaje</numerusform>
                <numerusform>%n viajes</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>&lt;p&gt;Shares &lt;b&gt;cones&lt;/b&gt; out among &lt;b&gt;robots&lt;/b&gt;. Robots load cones to place, and unload collected ones, at &lt;b&gt;stores&lt;/b&gt;, as often as their capacity asks for. Distances are those of the &lt;b&gt;roads&lt;/b&gt;; without roads they are straight lines, and the log says so.&lt;/p&gt; &lt;p&gt;Fields that layers may have, with the parameters as defaults: cones &lt;i&gt;id, heading, stage, task&lt;/i&gt; (place or collect), &lt;i&gt;demand, service_s&lt;/i&gt;; robots &lt;i&gt;id, capacity, speed, range_m, aboard, collected, ready_s&lt;/i&gt;; stores &lt;i&gt;id, service_s&lt;/i&gt;. Every cone of a lower &lt;b&gt;stage&lt;/b&gt; is done before one of a higher stage is begun.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Objective&lt;/b&gt;: &lt;i&gt;balanced&lt;/i&gt; has the last robot finish as early as possible, &lt;i&gt;distance&lt;/i&gt; drives the fewest metres in all. &lt;b&gt;Method&lt;/b&gt;: &lt;i&gt;pyvrp&lt;/i&gt; works until the time limit is over, &lt;i&gt;preview&lt;/i&gt; is quick; &lt;i&gt;automatic&lt;/i&gt; takes pyvrp where Python has it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Targets&lt;/b&gt; are the stops of each robot in order with their times, &lt;b&gt;paths&lt;/b&gt; the ways between them, &lt;b&gt;plan&lt;/b&gt; is all of it as JSON. A cone that cannot be served is named, and nothing is written.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:assigncones -- CONES=cones.gpkg ROBOTS=robots.gpkg STORES=stores.gpkg ROADS=roads.gpkg CAPACITY=8 TIME_LIMIT=10 TARGETS=targets.gpkg PATHS=paths.gpkg PLAN=plan.json&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Reparte &lt;b&gt;conos&lt;/b&gt; entre &lt;b&gt;robots&lt;/b&gt;. Los robots cargan los conos por colocar, y descargan los recogidos, en los &lt;b&gt;almacenes&lt;/b&gt;, tantas veces como pide su capacidad. Las distancias son por las &lt;b&gt;vías&lt;/b&gt;; sin vías son líneas rectas, y el registro lo dice.&lt;/p&gt; &lt;p&gt;Campos que pueden tener las capas, con los parámetros como valores por defecto: conos &lt;i&gt;id, heading, stage, task&lt;/i&gt; (place o collect), &lt;i&gt;demand, service_s&lt;/i&gt;; robots &lt;i&gt;id, capacity, speed, range_m, aboard, collected, ready_s&lt;/i&gt;; almacenes &lt;i&gt;id, service_s&lt;/i&gt;. Todos los conos de una &lt;b&gt;etapa&lt;/b&gt; (stage) inferior se hacen antes de empezar uno de una superior.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Criterio&lt;/b&gt;: &lt;i&gt;balanced&lt;/i&gt; hace que el último robot acabe lo antes posible, &lt;i&gt;distance&lt;/i&gt; recorre los mínimos metros en total. &lt;b&gt;Método&lt;/b&gt;: &lt;i&gt;pyvrp&lt;/i&gt; trabaja hasta que acaba el límite de tiempo, &lt;i&gt;preview&lt;/i&gt; es rápido; &lt;i&gt;automatic&lt;/i&gt; toma pyvrp si Python lo tiene.&lt;/p&gt; &lt;p&gt;Los &lt;b&gt;objetivos&lt;/b&gt; son las paradas de cada robot por orden con sus tiempos, los &lt;b&gt;caminos&lt;/b&gt; los trayectos entre ellas, el &lt;b&gt;plan&lt;/b&gt; es todo ello como JSON. Un cono que no se puede servir se nombra, y no se escribe nada.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:assigncones -- CONES=cones.gpkg ROBOTS=robots.gpkg STORES=stores.gpkg ROADS=roads.gpkg CAPACITY=8 TIME_LIMIT=10 TARGETS=targets.gpkg PATHS=paths.gpkg PLAN=plan.json&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Assign cones to robots</source>
            <translation>Asignar conos a robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>CONES holds no cone: there is nothing to plan.</source>
            <translation>CONES no tiene ningún cono: no hay nada que planificar.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Cones that a robot carries (default of field capacity)</source>
            <translation>Conos que lleva un robot (por defecto del campo capacity)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Field of the stage: cones of lower ones come first</source>
            <translation>Campo de la etapa: los conos de etapas más bajas van primero</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>JSON (*.json)</source>
            <translation>JSON (*.json)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Method</source>
            <translation>Método</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Method that was used</source>
            <translation>Método utilizado</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Metres of all robots</source>
            <translation>Metros de todos los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Metres that a robot's battery lasts, 0 for any (default of field range_m)</source>
            <translation>Metros que dura la batería de un robot, 0 para cualquiera (por defecto del campo range_m)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>No roads are given: distances and paths are straight lines.</source>
            <translation>No se dan vías: distancias y caminos son líneas rectas.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Objective</source>
            <translation>Criterio</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Paths</source>
            <translation>Caminos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Planned by {method} along {travel}: the last robot is done after {end_s:.0f} s, {metres:.0f} m in all</source>
            <translation>Planificado con {method} por {travel}: el último robot termina al cabo de {end_s:.0f} s, {metres:.0f} m en total</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Plans which robot places or collects which cone, on which trip, along which roads, and when.</source>
            <translation>Planifica qué robot coloca o recoge qué cono, en qué viaje, por qué vías y cuándo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Road centrelines (default: straight lines)</source>
            <translation>Ejes de vía (por defecto: líneas rectas)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robot {id}: {cones} on {trips}, {metres:.0f} m, done after {end_s:.0f} s</source>
            <translation>Robot {id}: {cones} en {trips}, {metres:.0f} m, termina al cabo de {end_s:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robots that drive</source>
            <translation>Robots que circulan</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robots, where they are</source>
            <translation>Robots, donde están</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds of a visit to a store (default of its field service_s)</source>
            <translation>Segundos de una visita a un almacén (por defecto de su campo service_s)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds to place or collect a cone (default of field service_s)</source>
            <translation>Segundos para colocar o recoger un cono (por defecto del campo service_s)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds until the last cone is done</source>
            <translation>Segundos hasta que está hecho el último cono</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds until the last robot has finished</source>
            <translation>Segundos hasta que termina el último robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Speed of a robot [m/s] (default of field speed)</source>
            <translation>Velocidad de un robot [m/s] (por defecto del campo speed)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Stores of cones</source>
            <translation>Almacenes de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Targets</source>
            <translation>Objetivos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The CRS of the cones is not known: give SITE_CRS, such as EPSG:32633.</source>
            <translation>El SRC de los conos no se conoce: dé SITE_CRS, como EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The plan</source>
            <translation>El plan</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The plan cannot be driven: {faults}. Please report this.</source>
            <translation>El plan no se puede recorrer: {faults}. Comuníquelo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Time limit [s]</source>
            <translation>Límite de tiempo [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Trips</source>
            <translation>Viajes</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>What is done with cones (default of field task)</source>
            <translation>Qué se hace con los conos (por defecto del campo task)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>What the ways follow</source>
            <translation>Qué siguen los recorridos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Where robots go at the end</source>
            <translation>Adónde van los robots al final</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>{name} {given} cannot be opened: check the file and the layer's name.</source>
            <translation>{name} {given} no se puede abrir: compruebe el archivo y el nombre de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>&lt;p&gt;Places a layout of traffic cones, either at a &lt;b&gt;point&lt;/b&gt;, turned to a &lt;b&gt;heading&lt;/b&gt; (degrees clockwise from north), or along a &lt;b&gt;line&lt;/b&gt; such as a road's centreline, from &lt;b&gt;start&lt;/b&gt; metres after its beginning. The layer has an id, the order of placing, the heading of travel, the colour and the role of each cone.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Dimensions&lt;/b&gt; change the standard's: &lt;code&gt;vehicle_width=1.7; lane_offset=3&lt;/code&gt;. The log lists those of the layout with their values. A wrong name or value is refused with what there is.&lt;/p&gt; &lt;p&gt;Every cone is &lt;b&gt;checked&lt;/b&gt;: on one of the surfaces (of the allowed classes), away from obstacles and from other cones. What is wrong becomes a layer of findings with the cone's id and the reason; the cones are placed nevertheless.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:conelayout -- LAYOUT=iso3888_1 POINT="640432,5193486.2 [EPSG:32633]" HEADING=90 DIMENSIONS="vehicle_width=1.7; exit_length=15" SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Coloca una disposición de conos de tráfico, o bien en un &lt;b&gt;punto&lt;/b&gt;, girada hacia un &lt;b&gt;rumbo&lt;/b&gt; (grados en sentido horario desde el norte), o bien a lo largo de una &lt;b&gt;línea&lt;/b&gt; como un eje de vía, a partir de &lt;b&gt;start&lt;/b&gt; metros de su comienzo. La capa tiene de cada cono un identificador, el orden de colocación, el rumbo de circulación, el color y el papel.&lt;/p&gt; &lt;p&gt;Las &lt;b&gt;dimensiones&lt;/b&gt; cambian las de la norma: &lt;code&gt;vehicle_width=1.7; lane_offset=3&lt;/code&gt;. El registro lista las de la disposición con sus valores. Un nombre o valor equivocado se rechaza diciendo qué hay.&lt;/p&gt; &lt;p&gt;Cada cono se &lt;b&gt;comprueba&lt;/b&gt;: en una de las superficies (de las clases permitidas), lejos de obstáculos y de otros conos. Lo que no está bien va a una capa de hallazgos con el identificador del cono y el motivo; los conos se colocan de todos modos.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:conelayout -- LAYOUT=iso3888_1 POINT="640432,5193486.2 [EPSG:32633]" HEADING=90 DIMENSIONS="vehicle_width=1.7; exit_length=15" SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>&lt;p&gt;Reads cones from a &lt;b&gt;CSV file&lt;/b&gt; in UTF-8, from a &lt;b&gt;track&lt;/b&gt; of Formula Student, or from a &lt;b&gt;layer&lt;/b&gt;. Tracks are YAML with &lt;i&gt;cones_left&lt;/i&gt;, &lt;i&gt;cones_right&lt;/i&gt;, &lt;i&gt;cones_orange&lt;/i&gt; and &lt;i&gt;cones_orange_big&lt;/i&gt;, SDF with models of cones, CSV with columns such as &lt;i&gt;blue_x&lt;/i&gt; and &lt;i&gt;blue_y&lt;/i&gt; for each colour, or CSV without a head line: colour, x, y. Of other tables the columns are named by parameters; only those of x and y are needed, and not even those for a layer of points with a CRS, which is taken as it lies. A file or layer with several layouts gives one of them, by &lt;b&gt;LAYOUT_FIELD&lt;/b&gt; and &lt;b&gt;LAYOUT&lt;/b&gt;.&lt;/p&gt; &lt;p&gt;Metres of a table are turned by &lt;b&gt;rotation&lt;/b&gt; (degrees, counter-clockwise) and then moved to the &lt;b&gt;origin&lt;/b&gt;. A row that cannot be read is named with its column, and nothing is placed.&lt;/p&gt; &lt;p&gt;Every cone is &lt;b&gt;checked&lt;/b&gt; as those of &lt;i&gt;Cone layout&lt;/i&gt; are.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importconelayout -- FILE=cone_layouts.csv COLOUR_FIELD=colour LAYOUT_FIELD=track LAYOUT=eufs_skidpad ORIGIN="640520,5193530 [EPSG:32633]" ROTATION=90 SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Lee conos de un &lt;b&gt;archivo CSV&lt;/b&gt; en UTF-8, de una &lt;b&gt;pista&lt;/b&gt; de Formula Student o de una &lt;b&gt;capa&lt;/b&gt;. Las pistas son YAML con &lt;i&gt;cones_left&lt;/i&gt;, &lt;i&gt;cones_right&lt;/i&gt;, &lt;i&gt;cones_orange&lt;/i&gt; y &lt;i&gt;cones_orange_big&lt;/i&gt;, SDF con modelos de conos, CSV con columnas como &lt;i&gt;blue_x&lt;/i&gt; y &lt;i&gt;blue_y&lt;/i&gt; para cada color, o CSV sin línea de cabecera: color, x, y. De las demás tablas, las columnas se nombran con parámetros; solo hacen falta las de x e y, y ni siquiera esas para una capa de puntos con SRC, que se toma tal como está. Un archivo o una capa con varias disposiciones da una de ellas, con &lt;b&gt;LAYOUT_FIELD&lt;/b&gt; y &lt;b&gt;LAYOUT&lt;/b&gt;.&lt;/p&gt; &lt;p&gt;Los metros de una tabla se giran según &lt;b&gt;rotation&lt;/b&gt; (grados, en sentido antihorario) y después se mueven al &lt;b&gt;origen&lt;/b&gt;. Una fila que no se puede leer se nombra con su columna, y no se coloca nada.&lt;/p&gt; &lt;p&gt;Cada cono se &lt;b&gt;comprueba&lt;/b&gt; como los de &lt;i&gt;Disposición de conos&lt;/i&gt;.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importconelayout -- FILE=cone_layouts.csv COLOUR_FIELD=colour LAYOUT_FIELD=track LAYOUT=eufs_skidpad ORIGIN="640520,5193530 [EPSG:32633]" ROTATION=90 SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Against the direction of the line</source>
            <translation>En sentido contrario a la línea</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Begin so far along the line [m]</source>
            <translation>Empezar a esta distancia a lo largo de la línea [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Both FILE and INPUT are</source>
            <translation>Se han dado FILE e INPUT a la vez</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Both POINT and LINE are</source>
            <translation>Se han dado POINT y LINE a la vez</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>CSV file, or track of Formula Student (YAML, SDF)</source>
            <translation>Archivo CSV o pista de Formula Student (YAML, SDF)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of colours</source>
            <translation>Columna de los colores</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of headings, clockwise from the y axis [degrees]</source>
            <translation>Columna de los rumbos, desde el eje y en sentido horario [grados]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of ids</source>
            <translation>Columna de los ids</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of roles</source>
            <translation>Columna de los papeles</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of the order of placing</source>
            <translation>Columna del orden de colocación</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of x [m]</source>
            <translation>Columna de x [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of y [m]</source>
            <translation>Columna de y [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column that names the layout of each row</source>
            <translation>Columna de la disposición</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Cone layout</source>
            <translation>Disposición de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Cone layouts ({kinds});;All files (*)</source>
            <translation>Disposiciones de conos ({kinds});;Todos los archivos (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>DIMENSIONS has {part!r}, which is not name=value with a number: write such as spacing=15.</source>
            <translation>DIMENSIONS tiene {part!r}, que no es nombre=valor con un número: escriba por ejemplo spacing=15.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Dimensions other than the standard's, as name=value; ...</source>
            <translation>Dimensiones distintas de las de la norma, como nombre=valor; ...</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>FILE {file} is none that is read: give one of {kinds}.</source>
            <translation>FILE: {file} no es de ningún tipo que se lea: dé uno de {kinds}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Heading, clockwise from north [degrees]</source>
            <translation>Rumbo, desde el norte en sentido horario [grados]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Id of the line's feature (default: the only one)</source>
            <translation>Id del objeto de la línea (por defecto: el único)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Ids begin with (default: the layout)</source>
            <translation>Los ids empiezan por (por defecto: la disposición)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Import cone layout</source>
            <translation>Importar disposición de conos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Layer, instead of a file</source>
            <translation>Capa, en lugar de un archivo</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Layout</source>
            <translation>Disposición</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Line to lie along, instead of a place</source>
            <translation>Línea por la que se extiende, en lugar de un punto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Name (default: the layout's, else the file's)</source>
            <translation>Nombre (por defecto: el de la disposición, si no el del archivo)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Neither FILE nor INPUT is</source>
            <translation>No se ha dado ni FILE ni INPUT</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Neither POINT nor LINE is</source>
            <translation>No se ha dado ni POINT ni LINE</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>ORIGIN is not given: say where the table's 0,0 goes.</source>
            <translation>No se ha dado ORIGIN: diga adónde va el 0,0 de la tabla.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Place of the layout's origin</source>
            <translation>Lugar del origen de la disposición</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Places a standard cone layout at a point and heading or along a line, and checks every cone.</source>
            <translation>Coloca una disposición de conos normalizada en un punto y rumbo o a lo largo de una línea, y comprueba cada cono.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Places the cones of a CSV file or a layer, turned and moved to their place, and checks them.</source>
            <translation>Coloca los conos de un archivo CSV o de una capa, girados y movidos a su lugar, y los comprueba.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Rotation, counter-clockwise [degrees]</source>
            <translation>Rotación, en sentido antihorario [grados]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The feature {id} of {layer} has no line with a length and a place in the site's CRS: correct it, or choose another.</source>
            <translation>El objeto {id} de {layer} no tiene ninguna línea con longitud y con lugar en el SRC del sitio: corríjalo, o elija otro.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The feature {id} of {sourcename} has {lines} lines: split it, or choose one that has one.</source>
            <translation>El objeto {id} de {sourcename} tiene {lines} líneas: divídalo, o elija uno que tenga una.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The layer {sourcename} has {found}: choose one line by LINE_ID, or select it and tick 'Selected features only'.</source>
            <translation>La capa {sourcename} tiene {found}: elija una línea con LINE_ID, o selecciónela y marque «Solo objetos seleccionados».</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The one layout to take, by that column</source>
            <translation>La única disposición que se toma, según esa columna</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Where the table's 0,0 goes</source>
            <translation>Adónde va el 0,0 de la tabla</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>no feature {wanted}</source>
            <translation>ningún objeto espacial {wanted}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>not exactly one feature</source>
            <translation>no exactamente un objeto espacial</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>{how} given: give a CSV file, or a layer.</source>
            <translation>{how}: dé un archivo CSV o una capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>{how} given: give the place of the layout, or a line that it lies along.</source>
            <translation>{how}: dé el lugar de la disposición, o una línea por la que se extienda.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>&lt;p&gt;Writes a robot map as other robots and people read it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Robot map&lt;/b&gt;: a file of &lt;i&gt;fleet:exportrobotmap&lt;/i&gt; or of the gateway, text or binary.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formats&lt;/b&gt;, several at once:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;occupancy&lt;/i&gt;: occupancy grid for Nav2 (PGM and YAML). What a wall touches is occupied, so thin walls have no gap; courtyards are free; the inside of obstacles is unknown, or occupied on request. The frame of the grid is the site frame.&lt;/li&gt; &lt;li&gt;&lt;i&gt;keepout&lt;/i&gt;: mask for Nav2's keepout filter, from the keepout layer, with the filter's parameters.&lt;/li&gt; &lt;li&gt;&lt;i&gt;speed&lt;/i&gt;: mask for Nav2's speed filter, from the speed layer and its expression in m/s. A limit is never rounded up; where areas overlap the lower one holds.&lt;/li&gt; &lt;li&gt;&lt;i&gt;geojson&lt;/i&gt;: obstacles and segments in WGS 84 (RFC 7946).&lt;/li&gt; &lt;li&gt;&lt;i&gt;geopackage&lt;/i&gt;: the same in the site's CRS.&lt;/li&gt; &lt;li&gt;&lt;i&gt;svg&lt;/i&gt;, &lt;i&gt;png&lt;/i&gt;: a picture for people.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;&lt;b&gt;Keepout and speed layers&lt;/b&gt; are polygons in any CRS. Where the map's place is not known, layers are taken to be in its own metres, and a warning says so; &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt; give it one.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Robots drive over&lt;/b&gt; obstacles that are lower: 0 keeps every kerb. Ramps are always driven on, stairs are obstacles, also from the side.&lt;/p&gt; &lt;p&gt;Existing files are replaced, each in one step, after all of them could be made. docs/navigation-maps.md says what is in each.&lt;/p&gt; &lt;p&gt;From a script, with no display:&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportnavigationmap -- MAP=campus.txt FORMATS=occupancy FORMATS=svg RESOLUTION=0.05 OUTPUT=campus&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Escribe un mapa de robots tal como lo leen otros robots y las personas.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Mapa de robots&lt;/b&gt;: un archivo de &lt;i&gt;fleet:exportrobotmap&lt;/i&gt; o de la pasarela, de texto o binario.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formatos&lt;/b&gt;, varios a la vez:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;occupancy&lt;/i&gt;: rejilla de ocupación para Nav2 (PGM y YAML). Lo que toca una pared está ocupado, así las paredes finas no tienen huecos; los patios están libres; el interior de los obstáculos es desconocido, u ocupado si se pide. El marco de la rejilla es el marco del recinto.&lt;/li&gt; &lt;li&gt;&lt;i&gt;keepout&lt;/i&gt;: máscara para el filtro keepout de Nav2, de la capa de zonas prohibidas, con los parámetros del filtro.&lt;/li&gt; &lt;li&gt;&lt;i&gt;speed&lt;/i&gt;: máscara para el filtro speed de Nav2, de la capa de velocidad y su expresión en m/s. Un límite nunca se redondea hacia arriba; donde las áreas se superponen vale el más bajo.&lt;/li&gt; &lt;li&gt;&lt;i&gt;geojson&lt;/i&gt;: obstáculos y segmentos en WGS 84 (RFC 7946).&lt;/li&gt; &lt;li&gt;&lt;i&gt;geopackage&lt;/i&gt;: lo mismo en el SRC del recinto.&lt;/li&gt; &lt;li&gt;&lt;i&gt;svg&lt;/i&gt;, &lt;i&gt;png&lt;/i&gt;: una imagen para las personas.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;Las &lt;b&gt;capas de zonas prohibidas y de velocidad&lt;/b&gt; son polígonos en cualquier SRC. Donde no se sabe el lugar del mapa, las capas se toman en sus propios metros, y un aviso lo dice; &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; y &lt;i&gt;ROTATION&lt;/i&gt; le dan uno.&lt;/p&gt; &lt;p&gt;Los &lt;b&gt;robots pasan por encima&lt;/b&gt; de los obstáculos más bajos: 0 conserva cada bordillo. Por las rampas se circula siempre, las escaleras son obstáculos, también de lado.&lt;/p&gt; &lt;p&gt;Los archivos existentes se sustituyen, cada uno de una vez, cuando todos se han podido hacer. docs/navigation-maps.md dice qué hay en cada uno.&lt;/p&gt; &lt;p&gt;Desde un script, sin pantalla:&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportnavigationmap -- MAP=campus.txt FORMATS=occupancy FORMATS=svg RESOLUTION=0.05 OUTPUT=campus&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Areas with a speed limit</source>
            <translation>Zonas con límite de velocidad</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Export navigation map</source>
            <translation>Exportar mapa de navegación</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>FORMATS has {format}, which needs {name}: give it, or leave {format} out.</source>
            <translation>FORMATS tiene {format}, que necesita {name}: délo, o quite {format}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>FORMATS is {formats}: choose of {known}.</source>
            <translation>FORMATS es {formats}: elija entre {known}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>File of format {name}</source>
            <translation>Archivo de formato {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Files</source>
            <translation>Archivos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Formats</source>
            <translation>Formatos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Inside of obstacles in the occupancy grid</source>
            <translation>Interior de los obstáculos en la rejilla de ocupación</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Keepout areas</source>
            <translation>Zonas prohibidas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Making {format}</source>
            <translation>Haciendo {format}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>NAME {name!r} is no file's name: leave out folders and leading dots.</source>
            <translation>NAME {name!r} no es un nombre de archivo: quite las carpetas y los puntos iniciales.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Name of the files (default: the robot map's)</source>
            <translation>Nombre de los archivos (por defecto: el del mapa de robots)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 keepout mask</source>
            <translation>máscara de zonas prohibidas de Nav2</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 occupancy grid</source>
            <translation>rejilla de ocupación de Nav2</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 speed mask</source>
            <translation>máscara de velocidad de Nav2</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Robots drive over what is lower than [m]</source>
            <translation>Los robots pasan sobre lo más bajo que [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Side of a cell of grid and masks [m]</source>
            <translation>Lado de una celda de la rejilla y las máscaras [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Speed limit of each area [m/s]</source>
            <translation>Límite de velocidad de cada zona [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>The coordinates of the keepout and speed layers are taken as the map's own metres.</source>
            <translation>Las coordenadas de las capas de zonas prohibidas y de velocidad se toman como metros del propio mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>The navigation map</source>
            <translation>El mapa de navegación</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Writes a robot map as Nav2 occupancy grid and masks, GeoJSON, GeoPackage, SVG or PNG.</source>
            <translation>Escribe un mapa de robots como rejilla de ocupación y máscaras de Nav2, GeoJSON, GeoPackage, SVG o PNG.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>above 0, such as 0.05</source>
            <translation>superior a 0, como 0.05</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>empty</source>
            <translation>vacío</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>occupied</source>
            <translation>ocupado</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>of 0 or more</source>
            <translation>de 0 o más</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>unknown</source>
            <translation>desconocido</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{name} is {value}: give a number of metres {wanted}.</source>
            <translation>{name} es {value}: dé un número de metros {wanted}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{parameter} {layer} cannot be opened: check the file and the layer's name.</source>
            <translation>{parameter} {layer} no se puede abrir: compruebe el archivo y el nombre de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{target} is the robot map itself: choose another NAME or OUTPUT.</source>
            <translation>{target} es el propio mapa de robots: elija otro NAME u OUTPUT.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{target}: {content} bytes</source>
            <translation>{target}: {content} bytes</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>%n edges</source>
            <translation>
                <numerusform>%n arista</numerusform>
                <numerusform>%n aristas</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>&lt;p&gt;Writes the network of road centrelines as other robots read it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formats&lt;/b&gt;, several at once:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;nav2&lt;/i&gt;: graph for Nav2's route server (GeoJSON). Nav2 drives straight from node to node, so every point of a road becomes a node.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lif&lt;/i&gt;: VDMA's Layout Interchange Format 1.0, for masters of VDA 5050 vehicles (JSON). Roads that are not straight have a trajectory.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lanelet2&lt;/i&gt;: lanes with borders for Lanelet2 and Autoware (OSM). Traffic keeps to the right, or to the left on request.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;Roads that are driven both ways become two edges; one-way roads one. Closed roads are left out, and so are edges that lead through a polygon of the &lt;b&gt;areas that must not be driven through&lt;/b&gt;. Speeds go over as limits.&lt;/p&gt; &lt;p&gt;Coordinates are metres in the &lt;b&gt;site frame&lt;/b&gt;, as on robot maps: &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt;, else as the project has it. Nav2 keeps 32 bits of a coordinate: give an origin on the site, or a warning says by how much places move.&lt;/p&gt; &lt;p&gt;Existing files are replaced, each in one step, after all of them could be made. docs/navigation-maps.md says what is in each.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportroadnetwork -- ROADS=roads.gpkg FORMATS=nav2 FORMATS=lif ORIGIN="640420,5193480" NAME=campus OUTPUT=graphs&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Escribe la red de ejes de vía tal como la leen otros robots.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formatos&lt;/b&gt;, varios a la vez:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;nav2&lt;/i&gt;: grafo para el servidor de rutas de Nav2 (GeoJSON). Nav2 circula recto de nodo a nodo, por eso cada punto de una vía se convierte en un nodo.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lif&lt;/i&gt;: Layout Interchange Format 1.0 de la VDMA, para controles de vehículos VDA 5050 (JSON). Las vías que no son rectas tienen una trayectoria.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lanelet2&lt;/i&gt;: carriles con bordes para Lanelet2 y Autoware (OSM). Se circula por la derecha, o por la izquierda si se pide.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;Las vías de dos sentidos se convierten en dos aristas; las de sentido único, en una. Las vías cerradas quedan fuera, y también las aristas que pasan por un polígono de las &lt;b&gt;áreas por donde no se debe circular&lt;/b&gt;. Las velocidades pasan como límites.&lt;/p&gt; &lt;p&gt;Las coordenadas son metros en el &lt;b&gt;marco del recinto&lt;/b&gt;, como en los mapas de robots: &lt;i&gt;ORIGIN&lt;/i&gt; y &lt;i&gt;ROTATION&lt;/i&gt;, si no el del proyecto. Nav2 conserva 32 bits de una coordenada: dé un origen en el recinto, o un aviso dirá cuánto se mueven los lugares.&lt;/p&gt; &lt;p&gt;Los archivos existentes se sustituyen, cada uno de una vez, cuando todos se han podido hacer. docs/navigation-maps.md dice qué hay en cada uno.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportroadnetwork -- ROADS=roads.gpkg FORMATS=nav2 FORMATS=lif ORIGIN="640420,5193480" NAME=campus OUTPUT=graphs&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Edges</source>
            <translation>Aristas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Export road network</source>
            <translation>Exportar red de vías</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>FORMATS is empty: choose of {known}.</source>
            <translation>FORMATS está vacío: elija entre {known}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 map (OSM)</source>
            <translation>Mapa Lanelet2 (OSM)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 needs longitudes and latitudes, and the CRS of the roads has no place on the Earth: give the layer its CRS, or leave lanelet2 out.</source>
            <translation>Lanelet2 necesita longitudes y latitudes, y el SRC de las vías no tiene lugar en la Tierra: dé a la capa su SRC, o deje fuera lanelet2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 reads lanes the wrong way round where corners are tighter than lanes are wide: {count} here, the first at ({x:.2f}, {y:.2f}). Draw the roads there smoother, or give them less width.</source>
            <translation>Lanelet2 lee los carriles al revés donde las curvas son más cerradas que la anchura de los carriles: aquí {count}, el primero en ({x:.2f}, {y:.2f}). Dibuje allí las vías más suaves, o deles menos anchura.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Name of the files</source>
            <translation>Nombre de los archivos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Nav2 keeps 32 bits of a coordinate, which here moves nodes by up to {metres:.2f} m: give ORIGIN, a place of the site, for robots and their maps alike.</source>
            <translation>Nav2 conserva 32 bits de una coordenada, lo que aquí mueve los nodos hasta {metres:.2f} m: dé ORIGIN, un lugar del recinto, tanto para los robots como para sus mapas.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Nav2 route graph (GeoJSON)</source>
            <translation>Grafo de rutas de Nav2 (GeoJSON)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Roads</source>
            <translation>Vías</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Robots' name for the site frame</source>
            <translation>Nombre del marco del recinto para los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>The road network</source>
            <translation>La red de vías</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Traffic keeps to the left (Lanelet2)</source>
            <translation>Se circula por la izquierda (Lanelet2)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Type of vehicle that drives here (LIF)</source>
            <translation>Tipo de vehículo que circula aquí (LIF)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>VDMA LIF, for VDA 5050 (JSON)</source>
            <translation>VDMA LIF, para VDA 5050 (JSON)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Writes the road network as a Nav2 route graph, a VDMA LIF layout or a Lanelet2 map.</source>
            <translation>Escribe la red de vías como grafo de rutas de Nav2, disposición VDMA LIF o mapa Lanelet2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>{name} {value!r} cannot be used: give a plain word.</source>
            <translation>{name} {value!r} no se puede usar: dé una palabra simple.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>&lt;p&gt;Writes the obstacles in a window of the site as a map that robots read: oriented segments with free space to their right, grouped by kind. Robots get metres in the &lt;b&gt;site frame&lt;/b&gt;: a projected CRS, an origin in it and a rotation.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Obstacle layers&lt;/b&gt;: lines and polygons, several at once, in any CRS. Curves become chords (2 cm). What the window cuts becomes open chains; no wall is invented on the border.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Window&lt;/b&gt;: a centre with width and height in metres, or an extent. Positions may name their CRS, as in &lt;i&gt;12.5,48.1 [EPSG:4326]&lt;/i&gt;; without one they are in the site CRS.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Site CRS&lt;/b&gt;: in metres, such as the local UTM zone. EPSG:3857 is refused, because its metres are not metres. Default: the project's CRS; without a project the layers' own. A local engineering CRS is used as it is.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Height, foot, label, outdoors&lt;/b&gt;: QGIS expressions; the foot is where a feature begins above the ground, and its height counts from there. What a layer keeps (menu Fleet Supervisor, Layer roles) wins over these. There its role makes flights of risers of a layer (stairs) or surfaces without height (ramp), its filter says which features count, and points of furniture get a shape. Default: the field &lt;i&gt;height&lt;/i&gt; or &lt;i&gt;height_m&lt;/i&gt;, on the ground, the layer's name, true. Where no height is known, the default height is used, said in a warning and marked &lt;i&gt;h=est&lt;/i&gt; in the map.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Map profile&lt;/b&gt;: a file that says by layer name what layers are: &lt;i&gt;openstreetmap&lt;/i&gt;, &lt;i&gt;upc_campus_nord&lt;/i&gt; or the path of one's own. It wins over what the layers keep.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Smaller maps&lt;/b&gt; (advanced, each off unless asked for): only what the robot's plane meets, without walls between or inside buildings, lines joined, fewer corners, no short segments, heights in steps. The log says how many obstacles and segments there were before and after. Walls between buildings, corners and short segments need the Python package shapely 2.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Format&lt;/b&gt;: text; binary (the text compressed, with a check sum), which needs the Python package zstandard; compact (about a third of binary, whole centimetres), which needs cbor2 instead. The file &lt;i&gt;docs/robot-map.md&lt;/i&gt; of the project describes them, and exports from a script.&lt;/p&gt; &lt;p&gt;Broken geometry is repaired where that is safe and left out where it is not. Each time a warning names the layer and the feature; the export goes on.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Escribe los obstáculos de una ventana del recinto como un mapa que leen los robots: segmentos orientados con espacio libre a su derecha, agrupados por tipo. Los robots reciben metros en el &lt;b&gt;marco del recinto&lt;/b&gt;: un SRC proyectado, un origen y una rotación.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Capas de obstáculos&lt;/b&gt;: líneas y polígonos, varias a la vez, en cualquier SRC. Las curvas se convierten en cuerdas (2 cm). Lo que corta la ventana se convierte en cadenas abiertas; no se inventa ninguna pared en el borde.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Ventana&lt;/b&gt;: un centro con anchura y altura en metros, o una extensión. Las posiciones pueden decir su SRC, como en &lt;i&gt;12.5,48.1 [EPSG:4326]&lt;/i&gt;; sin él, están en el SRC del recinto.&lt;/p&gt; &lt;p&gt;&lt;b&gt;SRC del recinto&lt;/b&gt;: en metros, como la zona UTM local. EPSG:3857 se rechaza, porque sus metros no son metros. Por defecto: el SRC del proyecto; sin proyecto, el de las capas. Un SRC local de ingeniería se usa tal como es.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Altura, pie, etiqueta, exterior&lt;/b&gt;: expresiones de QGIS; el pie es donde empieza un objeto espacial sobre el suelo, y su altura cuenta desde allí. Lo que guarda una capa (menú Fleet Supervisor, Papeles de las capas) prevalece. Allí su papel hace de una capa tramos de escalera (stairs) o superficies sin altura (ramp), su filtro dice qué objetos espaciales cuentan, y los puntos de mobiliario reciben una forma. Por defecto: el campo &lt;i&gt;height&lt;/i&gt; o &lt;i&gt;height_m&lt;/i&gt;, en el suelo, el nombre de la capa, verdadero. Donde no se sabe la altura se usa la altura por defecto, con un aviso y la marca &lt;i&gt;h=est&lt;/i&gt; en el mapa.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Perfil de mapa&lt;/b&gt;: un archivo que dice por el nombre qué son las capas: &lt;i&gt;openstreetmap&lt;/i&gt;, &lt;i&gt;upc_campus_nord&lt;/i&gt; o la ruta de uno propio. Prevalece sobre lo que guardan las capas.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Mapas más pequeños&lt;/b&gt; (avanzado, cada uno desactivado si no se pide): solo lo que corta el plano del robot, sin paredes entre edificios ni dentro, líneas unidas, menos esquinas, sin segmentos cortos, alturas en escalones. El registro dice cuántos obstáculos y segmentos había antes y después. Las paredes entre edificios, las esquinas y los segmentos cortos necesitan el paquete de Python shapely 2.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formato&lt;/b&gt;: texto; binario (el texto comprimido, con una suma de control), que necesita el paquete de Python zstandard; compacto (un tercio del binario, centímetros enteros), que necesita cbor2. El archivo &lt;i&gt;docs/robot-map.md&lt;/i&gt; del proyecto los describe, y también las exportaciones desde un script.&lt;/p&gt; &lt;p&gt;La geometría rota se repara donde es seguro y queda fuera donde no lo es. Cada vez un aviso nombra la capa y el objeto espacial; la exportación continúa.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Compactness [bytes/m²]</source>
            <translation>Compacidad [bytes/m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Export robot map</source>
            <translation>Exportar mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Foot of each feature above ground [m] (default: on it)</source>
            <translation>Inicio de cada objeto sobre el suelo [m] (por defecto: sobre él)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Height of each feature [m] (default: its field height)</source>
            <translation>Altura de cada objeto [m] (por defecto: su campo height)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Height where none is known, marked as estimated [m]</source>
            <translation>Altura donde no se conoce, marcada como estimada [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Label of each feature (default: the layer's name)</source>
            <translation>Etiqueta de cada objeto (por defecto: el nombre de la capa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Robot map</source>
            <translation>Mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Robot map, text (*.txt);;Robot map, binary (*.rmap)</source>
            <translation>Mapa de robots, texto (*.txt);;Mapa de robots, binario (*.rmap)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Segments</source>
            <translation>Segmentos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Size of the file [bytes]</source>
            <translation>Tamaño del archivo [bytes]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Such as "clearance" of arches, or 2.2 for signs; the height of a feature counts from there. The upper height of the robot's plane leaves out what begins above it.</source>
            <translation>Como "clearance" de los arcos, o 2.2 para las señales; la altura de un objeto se cuenta desde ahí. La altura superior del plano del robot omite lo que empieza por encima.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>There is no obstacle in the window, and no layer reaches it: the layers lie from ({x_min:.0f}, {y_min:.0f}) to ({x_max:.0f}, {y_max:.0f}) in the site frame. Check the order of the window's numbers, their CRS and the site CRS. To a robot this map says that all is free.</source>
            <translation>No hay ningún obstáculo en la ventana, y ninguna capa llega hasta ella: las capas están entre ({x_min:.0f}, {y_min:.0f}) y ({x_max:.0f}, {y_max:.0f}) en el marco del recinto. Compruebe el orden de los números de la ventana, su SRC y el SRC del recinto. A un robot este mapa le dice que todo está libre.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>There is no obstacle in the window: check its place and the site CRS.</source>
            <translation>No hay ningún obstáculo en la ventana: compruebe su lugar y el SRC del recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Whether each feature is outdoors (default: true)</source>
            <translation>Si cada objeto está en el exterior (por defecto: cierto)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Window {width:g} m x {height:g} m = {area:.0f} m², from ({x_min:.2f}, {y_min:.2f}) to ({x_max:.2f}, {y_max:.2f}) in the site frame</source>
            <translation>Ventana {width:g} m x {height:g} m = {area:.0f} m², de ({x_min:.2f}, {y_min:.2f}) a ({x_max:.2f}, {y_max:.2f}) en el marco del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Writes the obstacles of line and polygon layers inside a window as a map that robots read.</source>
            <translation>Escribe los obstáculos de capas de líneas y polígonos dentro de una ventana como mapa que leen los robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>{size} bytes in binary, {ratio:.3g} bytes/m²</source>
            <translation>{size} bytes en binario, {ratio:.3g} bytes/m²</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>{size} bytes of text, {ratio:.3g} bytes/m² (paper 1: about 3 bytes/m² as text)</source>
            <translation>{size} bytes de texto, {ratio:.3g} bytes/m² (artículo 1: unos 3 bytes/m² como texto)</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>%n tiles</source>
            <translation>
                <numerusform>%n tesela</numerusform>
                <numerusform>%n teselas</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>&lt;p&gt;Writes one robot map for each tile, as &lt;i&gt;Export robot map&lt;/i&gt; does for one window, and an index: a polygon for each tile with its file, border, counts and bytes. The layers are read once.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Grid&lt;/b&gt;: tiles of one size from the left-lower corner of the extent; the last ones reach beyond it. &lt;b&gt;Route&lt;/b&gt;: tiles centred on the lines of a layer, so close that two that follow each other share the overlap. Sizes are in metres along the site's axes.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Advanced&lt;/b&gt;: obstacles are reduced as in &lt;i&gt;Export robot map&lt;/i&gt;, before the tiles are cut. The log says how many obstacles and segments the whole area had before and after.&lt;/p&gt; &lt;p&gt;An obstacle has the same id in every tile that it reaches into. Either every tile and the index are there at the end, or, after a cancel or an error, none of them.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Escribe un mapa de robots para cada tesela, como &lt;i&gt;Exportar mapa de robots&lt;/i&gt; hace para una ventana, y un índice: un polígono para cada tesela con su archivo, el borde, los recuentos y los bytes. Las capas se leen una vez.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Rejilla&lt;/b&gt;: teselas de un tamaño desde la esquina inferior izquierda de la extensión; las últimas la sobrepasan. &lt;b&gt;Ruta&lt;/b&gt;: teselas centradas en las líneas de una capa, tan juntas que dos seguidas compartan el solape. Los tamaños son en metros a lo largo de los ejes del recinto.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Avanzado&lt;/b&gt;: los obstáculos se reducen como en &lt;i&gt;Exportar mapa de robots&lt;/i&gt;, antes de cortar las teselas. El registro dice cuántos obstáculos y segmentos tenía toda el área antes y después.&lt;/p&gt; &lt;p&gt;Un obstáculo tiene el mismo identificador en cada tesela a la que llega. O bien al final están todas las teselas y el índice, o bien, tras una cancelación o un error, ninguna.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Both EXTENT and ROUTE are given: give one of them, for a grid or for tiles along a route.</source>
            <translation>Se han dado EXTENT y ROUTE a la vez: dé uno, para una rejilla o para teselas a lo largo de una ruta.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Export robot map tiles</source>
            <translation>Exportar teselas del mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Extent of a grid (or choose a route)</source>
            <translation>Extensión de una rejilla (o elija una ruta)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Folder of the tiles</source>
            <translation>Carpeta de las teselas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Height of a tile, along y [m]</source>
            <translation>Altura de una tesela, en y [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Index of the tiles</source>
            <translation>Índice de las teselas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Leave out tiles without obstacles</source>
            <translation>Omitir las teselas sin obstáculos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Neither EXTENT nor ROUTE is given: give an extent for a grid, or a layer of lines to follow.</source>
            <translation>No se ha dado ni EXTENT ni ROUTE: dé una extensión para una rejilla, o una capa de líneas que seguir.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>OUTPUT {folder} is a file: choose a folder for the tiles.</source>
            <translation>OUTPUT {folder} es un archivo: elija una carpeta para las teselas.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>OVERLAP is {overlap} m: give 0 or more, and at most nine tenths of a tile's side.</source>
            <translation>OVERLAP es {overlap} m: dé 0 o más, y como máximo nueve décimas del lado de una tesela.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Obstacles in all tiles</source>
            <translation>Obstáculos en todas las teselas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE holds no line: choose a layer with the route to export along.</source>
            <translation>ROUTE no tiene ninguna línea: elija una capa con la ruta a lo largo de la cual exportar.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE {route} cannot be opened: choose a layer of lines.</source>
            <translation>ROUTE {route} no se puede abrir: elija una capa de líneas.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE: feature {id} of {layer}: {doubts}. Correct the filter of the layer.</source>
            <translation>ROUTE: objeto {id} de {layer}: {doubts}. Corrija el filtro de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Route, instead of a grid</source>
            <translation>Ruta, en lugar de una rejilla</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Segments in all tiles</source>
            <translation>Segmentos en todas las teselas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Size of all tiles [bytes]</source>
            <translation>Tamaño de todas las teselas [bytes]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>That would be {count} tiles, and {most_tiles} are the most: choose larger tiles, less overlap or a smaller area.</source>
            <translation>Serían {count} teselas, y {most_tiles} son el máximo: elija teselas más grandes, menos solape o una zona más pequeña.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The index</source>
            <translation>El índice</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The set of tiles</source>
            <translation>El juego de teselas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The {name} of a tile is {value} m: give at least 1 m, such as 100.</source>
            <translation>El tamaño ({name}) de una tesela es {value} m: dé al menos 1 m, como 100.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>There is no obstacle in any tile: check their place and the site CRS.</source>
            <translation>No hay ningún obstáculo en ninguna tesela: compruebe su lugar y el SRC del recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Tiles</source>
            <translation>Teselas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>What neighbouring tiles share [m]</source>
            <translation>Lo que comparten teselas vecinas [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Width of a tile, along x [m]</source>
            <translation>Anchura de una tesela, en x [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Writes many robot maps, in a grid or along a route, and a layer that tells which is where.</source>
            <translation>Escribe muchos mapas de robots, en rejilla o a lo largo de una ruta, y una capa que dice dónde está cada uno.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>{tiles}, {segments}, {size} bytes</source>
            <translation>{tiles}, {segments}, {size} bytes</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>&lt;p&gt;Reads a map of Nav2: the &lt;b&gt;YAML&lt;/b&gt; and the image that it names (PGM, PNG, BMP or JPEG), in the modes &lt;i&gt;trinary&lt;/i&gt;, &lt;i&gt;scale&lt;/i&gt; and &lt;i&gt;raw&lt;/i&gt;, with its thresholds, &lt;i&gt;negate&lt;/i&gt;, and origin with yaw.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Raster&lt;/b&gt;: a value for each cell, 0 free to 100 occupied, -1 unknown. &lt;b&gt;Obstacles&lt;/b&gt;: a polygon for each patch of cells of at least &lt;i&gt;OCCUPIED_FROM&lt;/i&gt;, along the edges of the cells.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Place&lt;/b&gt;: the map's metres are those of the site frame. &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt; say where that is; files of &lt;i&gt;Export navigation map&lt;/i&gt; say it themselves. Where neither does, the layers are in local metres, said in a warning.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importnavigationmap -- MAP=warehouse.yaml SITE_CRS=EPSG:32633 ORIGIN="640420,5193480 [EPSG:32633]" ROTATION=0 RASTER=warehouse.tif OBSTACLES=warehouse.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Lee un mapa de Nav2: el &lt;b&gt;YAML&lt;/b&gt; y la imagen que nombra (PGM, PNG, BMP o JPEG), en los modos &lt;i&gt;trinary&lt;/i&gt;, &lt;i&gt;scale&lt;/i&gt; y &lt;i&gt;raw&lt;/i&gt;, con sus umbrales, &lt;i&gt;negate&lt;/i&gt; y el origen con su giro.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Ráster&lt;/b&gt;: un valor para cada celda, de 0 libre a 100 ocupada, -1 desconocida. &lt;b&gt;Obstáculos&lt;/b&gt;: un polígono para cada mancha de celdas de al menos &lt;i&gt;OCCUPIED_FROM&lt;/i&gt;, a lo largo de los bordes de las celdas.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Lugar&lt;/b&gt;: los metros del mapa son los del marco del recinto. &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; y &lt;i&gt;ROTATION&lt;/i&gt; dicen dónde está; los archivos de &lt;i&gt;Exportar mapa de navegación&lt;/i&gt; lo dicen ellos mismos. Si nadie lo dice, las capas están en metros locales y un aviso lo dice.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importnavigationmap -- MAP=warehouse.yaml SITE_CRS=EPSG:32633 ORIGIN="640420,5193480 [EPSG:32633]" ROTATION=0 RASTER=warehouse.tif OBSTACLES=warehouse.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Import navigation map</source>
            <translation>Importar mapa de navegación</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Nav2 map (YAML)</source>
            <translation>Mapa de Nav2 (YAML)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Nav2 maps (*.yaml *.yml);;All files (*)</source>
            <translation>Mapas de Nav2 (*.yaml *.yml);;Todos los archivos (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Occupied cells</source>
            <translation>Celdas ocupadas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Occupied from [of 100]</source>
            <translation>Ocupada a partir de [de 100]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Raster</source>
            <translation>Ráster</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Reads a Nav2 occupancy grid or mask as raster, and polygons of what is occupied.</source>
            <translation>Lee una rejilla de ocupación o una máscara de Nav2 como ráster y polígonos de lo ocupado.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The Nav2 map {file} cannot be read: {error}</source>
            <translation>No se puede leer el mapa de Nav2 {file}: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The image {file} cannot be read as PGM, PNG, BMP or JPEG: {why}</source>
            <translation>No se puede leer la imagen {file} como PGM, PNG, BMP o JPEG: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The image {file} has no bands of 8 bits: save it as grey, without a palette.</source>
            <translation>La imagen {file} no tiene bandas de 8 bits: guárdela en gris, sin paleta.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster</source>
            <translation>El ráster</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster {file} cannot be written: QGIS reads rasters of this kind, and writes none. Give it a name that ends in .tif.</source>
            <translation>El ráster {file} no se puede escribir: QGIS lee rásteres de este tipo, y no escribe ninguno. Dele un nombre que termine en .tif.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster {file} cannot be written: {why}</source>
            <translation>No se puede escribir el ráster {file}: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>There is no file {file}: choose the YAML of a Nav2 map (MAP).</source>
            <translation>No hay ningún archivo {file}: elija el YAML de un mapa de Nav2 (MAP).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>There is no image {file}, which the map names: put it there, or correct the YAML.</source>
            <translation>No existe la imagen {file}, que el mapa nombra: póngala ahí o corrija el YAML.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Unknown cells</source>
            <translation>Celdas desconocidas</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n centrelines</source>
            <translation>
                <numerusform>%n eje</numerusform>
                <numerusform>%n ejes</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n obstacle outlines</source>
            <translation>
                <numerusform>%n contorno de obstáculo</numerusform>
                <numerusform>%n contornos de obstáculos</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n road surfaces</source>
            <translation>
                <numerusform>%n superficie de vía</numerusform>
                <numerusform>%n superficies de vía</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>&lt;p&gt;Writes the layers of a site into a folder with &lt;i&gt;site.toml&lt;/i&gt; and &lt;i&gt;site.gpkg&lt;/i&gt;, which &lt;i&gt;robot-bridge serve --site FOLDER&lt;/i&gt; serves.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Layers&lt;/b&gt;: those of the project by their roles (menu Fleet Supervisor, Layer roles), or by a &lt;b&gt;map profile&lt;/b&gt;, or the layers given here. Which features count, heights, where things begin above the ground, labels, road widths and shapes of furniture come from the expressions kept with the roles; heights, labels and widths else from the fields &lt;i&gt;height&lt;/i&gt; or &lt;i&gt;height_m&lt;/i&gt;, &lt;i&gt;surface&lt;/i&gt;, &lt;i&gt;name&lt;/i&gt;, &lt;i&gt;width_m&lt;/i&gt; or &lt;i&gt;width&lt;/i&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Version&lt;/b&gt;: 1 for a new folder, else one more than the version there. A folder that holds another site is refused unless &lt;b&gt;Replace&lt;/b&gt; is ticked.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Database&lt;/b&gt;: the site goes into PostgreSQL with PostGIS, too, or only there where no folder is given: the layers as tables, with views of the newest version in the schema &lt;i&gt;site_ID&lt;/i&gt;, and all that &lt;i&gt;robot-bridge serve --site postgresql://account@host/database#ID&lt;/i&gt; serves. It is a connection of QGIS's or such an address.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Bounds&lt;/b&gt;: the rectangle, along the axes of the site frame, that robots may be sent into. Obstacles are published up to 100 m beyond it, so that a robot at its edge is told what stands there.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Site CRS, origin, rotation&lt;/b&gt;: where the robots' (0, 0) is and how their x axis lies. Default: as the project has it.&lt;/p&gt; &lt;p&gt;An earlier publication is replaced only after the new one is complete; a cancel leaves it as it was. Broken geometry is repaired where that is safe and left out where it is not, each time with a warning that names the layer and the feature. One publication into a folder runs at a time.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Escribe las capas de un recinto en una carpeta con &lt;i&gt;site.toml&lt;/i&gt; y &lt;i&gt;site.gpkg&lt;/i&gt;, que sirve &lt;i&gt;robot-bridge serve --site FOLDER&lt;/i&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Capas&lt;/b&gt;: las del proyecto según sus papeles (menú Fleet Supervisor, Papeles de las capas), o según un &lt;b&gt;perfil de mapa&lt;/b&gt;, o las capas que se dan aquí. Qué objetos espaciales cuentan, las alturas, dónde empiezan las cosas sobre el suelo, las etiquetas, las anchuras de las vías y las formas del mobiliario vienen de las expresiones que se guardan con los papeles; las alturas, etiquetas y anchuras si no de los campos &lt;i&gt;height&lt;/i&gt; o &lt;i&gt;height_m&lt;/i&gt;, &lt;i&gt;surface&lt;/i&gt;, &lt;i&gt;name&lt;/i&gt;, &lt;i&gt;width_m&lt;/i&gt; o &lt;i&gt;width&lt;/i&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Versión&lt;/b&gt;: 1 para una carpeta nueva, si no una más que la que hay. Una carpeta con otro recinto se rechaza si no se marca &lt;b&gt;Sustituir&lt;/b&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Base de datos&lt;/b&gt;: el recinto va también a PostgreSQL con PostGIS, o solo allí si no se da ninguna carpeta: las capas como tablas, con vistas de la versión más nueva en el esquema &lt;i&gt;site_ID&lt;/i&gt;, y todo lo que sirve &lt;i&gt;robot-bridge serve --site postgresql://account@host/database#ID&lt;/i&gt;. Es una conexión de QGIS o una dirección como esa.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Límites&lt;/b&gt;: el rectángulo, a lo largo de los ejes del marco del recinto, al que se pueden enviar robots. Los obstáculos se publican hasta 100 m más allá, para que un robot en el borde sepa qué hay.&lt;/p&gt; &lt;p&gt;&lt;b&gt;SRC, origen y rotación del recinto&lt;/b&gt;: dónde está el (0, 0) de los robots y cómo está su eje x. Por defecto: como lo tiene el proyecto.&lt;/p&gt; &lt;p&gt;Una publicación anterior solo se sustituye cuando la nueva está completa; una cancelación la deja como estaba. La geometría rota se repara donde es seguro y queda fuera donde no lo es, cada vez con un aviso que nombra la capa y el objeto espacial. Solo se hace una publicación a la vez en una carpeta.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Id of the site</source>
            <translation>Id del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Obstacle outlines</source>
            <translation>Contornos de obstáculos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Publish site</source>
            <translation>Publicar recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Schema of the site's views in the database</source>
            <translation>Esquema de las vistas del recinto en la base de datos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Site {id} version {version} is published in {folder}: {outlines}, {centrelines}, {surfaces}, {keepouts}; bounds {bounds} m</source>
            <translation>El recinto {id} versión {version} se publicó en {folder}: {outlines}, {centrelines}, {surfaces}, {keepouts}; límites {bounds} m</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>The origin of the site frame is 0,0 of {crs}, {away:.0f} km from the site: robots get positions of seven digits. Give ORIGIN, a place of the site, unless that is meant.</source>
            <translation>El origen del marco del recinto es 0,0 de {crs}, a {away:.0f} km del recinto: los robots reciben posiciones de siete cifras. Indique ORIGIN, un punto del recinto, si no es lo que quiere.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>The tables in the schema {schema} of an earlier version are in use: they stay until the next publication.</source>
            <translation>Las tablas de una versión anterior en el esquema {schema} están en uso: se quedan hasta la publicación siguiente.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>There is nothing to publish: the layers hold nothing that can be read. See the warnings, or give BOUNDS to publish an empty site.</source>
            <translation>No hay nada que publicar: las capas no contienen nada legible. Vea los avisos, o dé BOUNDS para publicar un recinto vacío.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Version of the site</source>
            <translation>Versión del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Writes the layers of a site, by their roles, into the folder that a gateway serves.</source>
            <translation>Escribe las capas de un recinto, según sus papeles, en la carpeta que sirve una pasarela.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>the database, schema {schema}</source>
            <translation>la base de datos, esquema {schema}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>&lt;p&gt;Checks a robot map, text or binary, and makes a layer of lines that show what is odd, each with a kind, a severity, the obstacle to look at, and what to do.&lt;/p&gt; &lt;p&gt;&lt;b&gt;orientation&lt;/b&gt;: outlines, courtyards, segments or risers that run the wrong way round. &lt;b&gt;gap&lt;/b&gt;: rings that do not close, and lines that stop just short of another obstacle. &lt;b&gt;sliver&lt;/b&gt;: rings next to nothing wide, segments without length. &lt;b&gt;duplicate&lt;/b&gt;, &lt;b&gt;overlap&lt;/b&gt;: obstacles that repeat, cross or cover one another or lie inside another. &lt;b&gt;shared wall&lt;/b&gt;: where two outlines touch back to back. &lt;b&gt;pocket&lt;/b&gt;: free space that a robot of the given width cannot reach; courtyards are such pockets. &lt;b&gt;height&lt;/b&gt;: heights of 0 or less, or above 0 where there must be none. &lt;b&gt;outside&lt;/b&gt;: segments beyond the border. &lt;b&gt;id&lt;/b&gt;: ids used twice.&lt;/p&gt; &lt;p&gt;Severities: &lt;i&gt;error&lt;/i&gt; misleads a robot, &lt;i&gt;warning&lt;/i&gt; is probably not meant, &lt;i&gt;info&lt;/i&gt; is worth knowing. The map itself is not changed.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Comprueba un mapa de robots, de texto o binario, y hace una capa de líneas que muestran qué es extraño, cada una con un tipo, una gravedad, el obstáculo que hay que mirar y qué hay que hacer.&lt;/p&gt; &lt;p&gt;&lt;b&gt;orientation&lt;/b&gt;: contornos, patios, segmentos o escalones que van en el sentido equivocado. &lt;b&gt;gap&lt;/b&gt;: anillos que no se cierran, y líneas que se detienen justo antes de otro obstáculo. &lt;b&gt;sliver&lt;/b&gt;: anillos casi sin anchura, segmentos sin longitud. &lt;b&gt;duplicate&lt;/b&gt;, &lt;b&gt;overlap&lt;/b&gt;: obstáculos que se repiten, se cruzan o se cubren, o están dentro de otro. &lt;b&gt;shared wall&lt;/b&gt;: donde dos contornos se tocan de espaldas. &lt;b&gt;pocket&lt;/b&gt;: espacio libre al que no puede llegar un robot de la anchura dada; los patios lo son. &lt;b&gt;height&lt;/b&gt;: alturas de 0 o menos, o superiores a 0 donde no puede haberlas. &lt;b&gt;outside&lt;/b&gt;: segmentos más allá del borde. &lt;b&gt;id&lt;/b&gt;: identificadores usados dos veces.&lt;/p&gt; &lt;p&gt;Gravedades: &lt;i&gt;error&lt;/i&gt; engaña a un robot, &lt;i&gt;warning&lt;/i&gt; probablemente no es intencionado, &lt;i&gt;info&lt;/i&gt; vale la pena saberlo. El mapa mismo no se cambia.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>&lt;p&gt;Reads a robot map, text or binary, and makes layers of it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Obstacles that are areas&lt;/b&gt;: outlines that close, courtyards as holes. &lt;b&gt;Obstacles that are lines&lt;/b&gt;: walls, stairs, and what the border of the map cuts. &lt;b&gt;Segments&lt;/b&gt;: each from a to b, with free space on its right; the style shows that side by ticks and the height by colour. Fields: id, shape, labels, height, indoors or outdoors, extras (&lt;i&gt;ext&lt;/i&gt;, as JSON).&lt;/p&gt; &lt;p&gt;&lt;b&gt;Place&lt;/b&gt;: a map may name its CRS, origin and rotation in its leading lines; parameters win over them. Where neither does, the layers are in local metres, said in a warning.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Lee un mapa de robots, de texto o binario, y hace capas de él.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Obstáculos que son áreas&lt;/b&gt;: contornos que se cierran, con los patios como huecos. &lt;b&gt;Obstáculos que son líneas&lt;/b&gt;: paredes, escaleras, y lo que corta el borde del mapa. &lt;b&gt;Segmentos&lt;/b&gt;: cada uno de a a b, con espacio libre a su derecha; el estilo muestra ese lado con rayitas y la altura con el color. Campos: identificador, forma, etiquetas, altura, interior o exterior, extras (&lt;i&gt;ext&lt;/i&gt;, como JSON).&lt;/p&gt; &lt;p&gt;&lt;b&gt;Lugar&lt;/b&gt;: un mapa puede decir su SRC, el origen y la rotación en sus líneas iniciales; los parámetros prevalecen. Donde no lo dice ninguno, las capas están en metros locales, con un aviso.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Border of the map</source>
            <translation>Límite del mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Check robot map</source>
            <translation>Comprobar mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Errors</source>
            <translation>Errores</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Findings</source>
            <translation>Hallazgos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Finds turned outlines, gaps, slivers, repeats, overlaps and unreachable pockets in a robot map.</source>
            <translation>Encuentra contornos girados, huecos, astillas, repeticiones, solapes y rincones inaccesibles en un mapa de robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Load robot map</source>
            <translation>Cargar mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Longest gap that was not meant [m]</source>
            <translation>Hueco más largo que no es intencionado [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Narrowest ring that is an obstacle [m]</source>
            <translation>Anillo más estrecho que es un obstáculo [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Nothing is odd in this map.</source>
            <translation>No hay nada extraño en este mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Obstacles that are areas</source>
            <translation>Obstáculos que son áreas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Obstacles that are lines</source>
            <translation>Obstáculos que son líneas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Smallest unreachable pocket [m²]</source>
            <translation>Rincón inaccesible más pequeño [m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Turns a robot map, text or binary, into layers with all that the map says.</source>
            <translation>Convierte un mapa de robots, texto o binario, en capas con todo lo que dice el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Width of the robot, for unreachable pockets [m]</source>
            <translation>Anchura del robot, para los rincones inaccesibles [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Worth knowing</source>
            <translation>Conviene saberlo</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n nodes</source>
            <translation>
                <numerusform>%n nodo</numerusform>
                <numerusform>%n nodos</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n parts</source>
            <translation>
                <numerusform>%n parte</numerusform>
                <numerusform>%n partes</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n points</source>
            <translation>
                <numerusform>%n punto</numerusform>
                <numerusform>%n puntos</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n repairs</source>
            <translation>
                <numerusform>%n reparación</numerusform>
                <numerusform>%n reparaciones</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Checks the network that road centrelines make, and makes a layer of points that show what is odd, each with the feature to look at. Nothing is changed.&lt;/p&gt; &lt;p&gt;What &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; repairs: &lt;b&gt;gap&lt;/b&gt;, an end that stops within the tolerance of another road; &lt;b&gt;overshoot&lt;/b&gt;, an end that reaches beyond a road by less than that; &lt;b&gt;duplicate&lt;/b&gt;, a stretch that is drawn twice.&lt;/p&gt; &lt;p&gt;What only people can judge: &lt;b&gt;dead end&lt;/b&gt;; &lt;b&gt;disconnected part&lt;/b&gt;, roads that are connected with one another but not with the longest part; &lt;b&gt;one-way&lt;/b&gt;, roads from which no way leads back because of the directions.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Comprueba la red que hacen los ejes de vía, y hace una capa de puntos que muestran qué es extraño, cada uno con el objeto espacial que hay que mirar. No se cambia nada.&lt;/p&gt; &lt;p&gt;Lo que repara &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt;: &lt;b&gt;hueco&lt;/b&gt; (gap), un extremo que se detiene dentro de la tolerancia de otra vía; &lt;b&gt;exceso&lt;/b&gt; (overshoot), un extremo que sobrepasa una vía por menos que eso; &lt;b&gt;duplicado&lt;/b&gt; (duplicate), un tramo dibujado dos veces.&lt;/p&gt; &lt;p&gt;Lo que solo pueden juzgar las personas: &lt;b&gt;callejón sin salida&lt;/b&gt; (dead end); &lt;b&gt;parte desconectada&lt;/b&gt; (disconnected part), vías conectadas entre sí pero no con la parte más larga; &lt;b&gt;sentido único&lt;/b&gt; (one-way), vías de las que no se puede volver a causa de los sentidos.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Finds the way between two places near roads: each is taken to the nearest point of a road that may be used. Closed roads are not used, one-way roads in their direction only; &lt;b&gt;surfaces&lt;/b&gt; (names with commas between) and a &lt;b&gt;least width&lt;/b&gt; restrict the way further.&lt;/p&gt; &lt;p&gt;Edges that lead through a polygon of the &lt;b&gt;areas that must not be driven through&lt;/b&gt; are closed; what runs along a rim is not.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Route&lt;/b&gt; has a line for each stretch of road, in order. &lt;b&gt;Path&lt;/b&gt; is what a robot drives: points at most so far apart, corners rounded to the turning radius as far as robot and road are wide. Corners that stay tighter are counted and named in the log.&lt;/p&gt; &lt;p&gt;The &lt;b&gt;engine&lt;/b&gt; is RoutingKit or SciPy where Python has them, else QGIS's own; the log and &lt;i&gt;ENGINE_USED&lt;/i&gt; say which was used. All find the same ways.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:route -- ROADS=roads.gpkg START="640430,5193530 [EPSG:32633]" GOAL="640600,5193570 [EPSG:32633]" SURFACES=asphalt ROUTE=route.gpkg PATH=path.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Encuentra el camino entre dos lugares cerca de vías: cada uno se lleva al punto más cercano de una vía que se puede usar. Las vías cerradas no se usan, las de sentido único solo en su sentido; las &lt;b&gt;superficies&lt;/b&gt; (nombres separados por comas) y una &lt;b&gt;anchura mínima&lt;/b&gt; restringen más el camino.&lt;/p&gt; &lt;p&gt;Las aristas que pasan por un polígono de las &lt;b&gt;áreas por donde no se debe circular&lt;/b&gt; están cerradas; lo que va por un borde no.&lt;/p&gt; &lt;p&gt;La &lt;b&gt;ruta&lt;/b&gt; tiene una línea para cada tramo de vía, por orden. El &lt;b&gt;camino&lt;/b&gt; es lo que recorre un robot: puntos separados como máximo esa distancia, esquinas redondeadas al radio de giro hasta donde lo permiten las anchuras del robot y de la vía. Las esquinas que quedan más cerradas se cuentan y se nombran en el registro.&lt;/p&gt; &lt;p&gt;El &lt;b&gt;motor&lt;/b&gt; es RoutingKit o SciPy si Python los tiene, si no el de QGIS; el registro y &lt;i&gt;ENGINE_USED&lt;/i&gt; dicen cuál se usó. Todos encuentran los mismos caminos.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:route -- ROADS=roads.gpkg START="640430,5193530 [EPSG:32633]" GOAL="640600,5193570 [EPSG:32633]" SURFACES=asphalt ROUTE=route.gpkg PATH=path.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Splits road centrelines where they cross or touch, and makes a layer of edges and one of nodes.&lt;/p&gt; &lt;p&gt;Roads of different &lt;b&gt;levels&lt;/b&gt; meet only where one of them ends in a point of the other: a bridge is reached at its ends and passes over what is between them. &lt;b&gt;Direction&lt;/b&gt;, speed, width, surface and whether a road is closed go over to its edges.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Repair&lt;/b&gt; moves ends that stop within the tolerance of a road onto it, cuts off ends that reach beyond a road by less, and leaves out what is drawn twice; the log names each repair. &lt;i&gt;fleet:checkroadnetwork&lt;/i&gt; shows what is broken without changing anything.&lt;/p&gt; &lt;p&gt;The fields of the edges are those that this algorithm and &lt;i&gt;fleet:route&lt;/i&gt; read by themselves. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Corta los ejes de vía donde se cruzan o se tocan, y hace una capa de aristas y una de nodos.&lt;/p&gt; &lt;p&gt;Las vías de &lt;b&gt;niveles&lt;/b&gt; distintos solo se encuentran donde una de ellas acaba en un punto de la otra: a un puente se entra por los extremos y pasa por encima de lo que hay en medio. El &lt;b&gt;sentido&lt;/b&gt;, la velocidad, la anchura, la superficie y si una vía está cerrada pasan a sus aristas.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Reparar&lt;/b&gt; lleva hasta una vía los extremos que se detienen dentro de la tolerancia, corta los que la sobrepasan por menos, y deja fuera lo que está dibujado dos veces; el registro nombra cada reparación. &lt;i&gt;fleet:checkroadnetwork&lt;/i&gt; muestra qué está roto sin cambiar nada.&lt;/p&gt; &lt;p&gt;Los campos de las aristas son los que este algoritmo y &lt;i&gt;fleet:route&lt;/i&gt; leen por sí solos. docs/roads.md dice más.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Build road network</source>
            <translation>Construir red de vías</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Check road network</source>
            <translation>Comprobar red de vías</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Corners tighter than the robot turns</source>
            <translation>Esquinas más cerradas que el giro del robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Dead ends</source>
            <translation>Callejones sin salida</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Edges without a way back</source>
            <translation>Aristas sin camino de vuelta</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Engine</source>
            <translation>Motor</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Engine that was used</source>
            <translation>Motor utilizado</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Finds gaps, overshoots, duplicates, dead ends, separate parts and one-way traps in road centrelines.</source>
            <translation>Encuentra huecos, sobrepasos, duplicados, callejones sin salida, partes separadas y trampas de sentido único en los ejes de vía.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Finds the shortest or fastest way along road centrelines, and the path that a robot drives.</source>
            <translation>Encuentra el recorrido más corto o más rápido por los ejes de vía, y el camino que hace un robot.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Gaps</source>
            <translation>Huecos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Goal</source>
            <translation>Final</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Length of the route [m]</source>
            <translation>Longitud de la ruta [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Nodes</source>
            <translation>Nodos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Nothing is odd in this network.</source>
            <translation>No hay nada extraño en esta red.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Overshoots</source>
            <translation>Sobrepasos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Parts of their own</source>
            <translation>Partes separadas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Parts that are not connected</source>
            <translation>Partes no conectadas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Path</source>
            <translation>Camino</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Points of the path</source>
            <translation>Puntos del camino</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Repairs</source>
            <translation>Reparaciones</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Roads drawn twice</source>
            <translation>Vías dibujadas dos veces</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Route</source>
            <translation>Ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Route on roads</source>
            <translation>Ruta por vías</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Splits road centrelines where they meet, passes over and under at bridges, and repairs on request.</source>
            <translation>Divide los ejes de vía donde se encuentran, pasa por encima y por debajo en los puentes, y repara si se pide.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Start</source>
            <translation>Inicio</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>The corner at ({x:.2f}, {y:.2f}) is tighter than the robot turns.</source>
            <translation>La esquina en ({x:.2f}, {y:.2f}) es más cerrada que el giro del robot.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Time on the route [s]</source>
            <translation>Tiempo de la ruta [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>fastest</source>
            <translation>la más rápida</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>none: plain Python</source>
            <translation>ninguno: solo Python</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>shortest</source>
            <translation>la más corta</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>the fastest that is installed</source>
            <translation>el más rápido de los instalados</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>{metres:.1f} m, {seconds:.1f} s, {points}, found by {engine}; start {off_start:.2f} m and goal {off_goal:.2f} m from the road</source>
            <translation>{metres:.1f} m, {seconds:.1f} s, {points}, encontrada por {engine}; inicio a {off_start:.2f} m y final a {off_goal:.2f} m de la vía</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>%n of the surfaces that are given as drawn say that they were generated (field origin); they are left out and made anew</source>
            <translation>
                <numerusform>%n de las superficies dadas como dibujadas dice que se generó (campo origin); se omite y se vuelve a hacer</numerusform>
                <numerusform>%n de las superficies dadas como dibujadas dicen que se generaron (campo origin); se omiten y se vuelven a hacer</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>%n points are on a surface, {off} on none.</source>
            <translation>
                <numerusform>%n punto está sobre una superficie, {off} sobre ninguna.</numerusform>
                <numerusform>%n puntos están sobre una superficie, {off} sobre ninguna.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>&lt;p&gt;Copies points and adds &lt;b&gt;surface&lt;/b&gt;, the class of the road surface that each is on, its &lt;b&gt;surface_name&lt;/b&gt;, and &lt;b&gt;surface_origin&lt;/b&gt;: whether the surface was drawn or generated from centrelines. They are empty where there is no surface.&lt;/p&gt; &lt;p&gt;The surfaces are layers of areas with a field &lt;i&gt;surface&lt;/i&gt;, or the class that their role says; without any, the project's layers with the role road surface. Points and layers may be in any CRS.&lt;/p&gt; &lt;p&gt;A point on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a generated one, then the smaller before the larger. The expression &lt;i&gt;road_surface(x, y)&lt;/i&gt; tells the same. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Copia puntos y añade &lt;b&gt;surface&lt;/b&gt;, la clase de la superficie de vía en que está cada uno, su &lt;b&gt;surface_name&lt;/b&gt;, y &lt;b&gt;surface_origin&lt;/b&gt;: si la superficie es dibujada o generada de los ejes. Están vacíos donde no hay superficie.&lt;/p&gt; &lt;p&gt;Las superficies son capas de áreas con un campo &lt;i&gt;surface&lt;/i&gt;, o la clase que dice su papel; si no se da ninguna, las capas del proyecto con el papel de superficie de vía. Los puntos y las capas pueden estar en cualquier SRC.&lt;/p&gt; &lt;p&gt;Un punto en el borde está en la superficie. Donde las superficies se superponen cuenta antes una dibujada que una generada, y después la menor antes que la mayor. La expresión &lt;i&gt;road_surface(x, y)&lt;/i&gt; dice lo mismo. docs/roads.md dice más.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>&lt;p&gt;Widens road centrelines by half their width to each side: ends are cut square, corners are mitred, within a road and where roads end in one point. What is of one class, such as asphalt, becomes one surface; pieces that do not touch are features of their own.&lt;/p&gt; &lt;p&gt;No ground is in two surfaces. Surfaces &lt;b&gt;drawn by hand&lt;/b&gt; keep theirs and are copied to the result. Among generated ones the class that comes first in &lt;b&gt;precedence&lt;/b&gt; keeps the ground; of classes that are not named there the one with less ground, and what has no class comes last.&lt;/p&gt; &lt;p&gt;A road whose width is not known is as wide as &lt;b&gt;default width&lt;/b&gt; says, and is in the layer of &lt;b&gt;findings&lt;/b&gt;. Ends that stop just short of another road stay apart: mend them with &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; and give its edges.&lt;/p&gt; &lt;p&gt;Give the result the role road surface to publish it. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Ensancha los ejes de vía la mitad de su anchura a cada lado: los extremos se cortan rectos y las esquinas se hacen en punta, dentro de una vía y donde varias vías acaban en un punto. Lo que es de una clase, como asfalto, se convierte en una superficie; los trozos que no se tocan son objetos espaciales propios.&lt;/p&gt; &lt;p&gt;Ningún terreno está en dos superficies. Las &lt;b&gt;dibujadas a mano&lt;/b&gt; conservan el suyo y se copian al resultado. Entre las generadas conserva el terreno la clase que va primero en la &lt;b&gt;precedencia&lt;/b&gt;; de las que no se nombran allí, la que tiene menos terreno, y lo que no tiene clase va lo último.&lt;/p&gt; &lt;p&gt;Una vía de anchura desconocida es tan ancha como dice la &lt;b&gt;anchura por defecto&lt;/b&gt;, y sale en la capa de &lt;b&gt;hallazgos&lt;/b&gt;. Los extremos que se detienen justo antes de otra vía quedan separados: arréglelos con &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; y dé sus aristas.&lt;/p&gt; &lt;p&gt;Dé al resultado el papel de superficie de vía para publicarlo. docs/roads.md dice más.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Adds to points, in any CRS, the class of the road surface that they are on.</source>
            <translation>Añade a puntos, en cualquier SRC, la clase de la superficie de vía donde están.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Area [m²]</source>
            <translation>Área [m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Build road surfaces</source>
            <translation>Construir superficies de vía</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Classes that keep their ground, the first before the second</source>
            <translation>Clases que conservan su suelo, la primera antes que la segunda</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Feature {id} has points on several surfaces; none is given for it</source>
            <translation>El objeto {id} tiene puntos sobre varias superficies; no se da ninguna</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Generated ones</source>
            <translation>Generadas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>No road surfaces are given, and no layer of the project has the role road surface: give SURFACES, or set the role in Plugins &gt; Fleet Supervisor &gt; Layer roles.</source>
            <translation>No se dan superficies de vía, y ninguna capa del proyecto tiene el papel superficie de vía: dé SURFACES, o ponga el papel en Complementos &gt; Fleet Supervisor &gt; Papeles de las capas.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>POINTS {name} is a table without places: make points of its columns first, by native:createpointslayerfromtable.</source>
            <translation>POINTS {name} es una tabla sin lugares: haga primero puntos de sus columnas con native:createpointslayerfromtable.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points</source>
            <translation>Puntos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points on a surface</source>
            <translation>Puntos sobre una superficie</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points on none</source>
            <translation>Puntos sobre ninguna</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points with surface</source>
            <translation>Puntos con superficie</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Road surfaces (default: the project's layers with that role)</source>
            <translation>Superficies de vía (por defecto: las capas del proyecto con ese papel)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Roads without a width</source>
            <translation>Vías sin anchura</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Surface at point</source>
            <translation>Superficie en el punto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Surfaces drawn by hand, which keep their ground</source>
            <translation>Superficies dibujadas a mano, que conservan su terreno</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>The width of this road is not known; {width:g} m is used.</source>
            <translation>La anchura de esta vía no se conoce; se usa {width:g} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Widens centrelines to surfaces, one for each class; surfaces drawn by hand keep their ground.</source>
            <translation>Ensancha los ejes en superficies, una por clase; las dibujadas a mano conservan su terreno.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>without a class</source>
            <translation>sin clase</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>{label}: {area:.1f} m²</source>
            <translation>{label}: {area:.1f} m²</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n features have no place, robot or time; they are left out.</source>
            <translation>
                <numerusform>%n objeto espacial no tiene lugar, robot o tiempo; queda fuera.</numerusform>
                <numerusform>%n objetos espaciales no tienen lugar, robot o tiempo; quedan fuera.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n lines</source>
            <translation>
                <numerusform>%n línea</numerusform>
                <numerusform>%n líneas</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n positions</source>
            <translation>
                <numerusform>%n posición</numerusform>
                <numerusform>%n posiciones</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n values of the field {name} are no numbers, and count as no speed.</source>
            <translation>
                <numerusform>%n valor del campo {name} no es un número, y no cuenta como velocidad.</numerusform>
                <numerusform>%n valores del campo {name} no son números, y no cuentan como velocidad.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>&lt;p&gt;Makes of the positions that a gateway stored one line for each drive of each robot: a robot that was not heard of for longer than the gap begins a new line. Or, with &lt;b&gt;a line for each step&lt;/b&gt;, one for each pair of positions, for colours by speed and for QGIS's temporal controller.&lt;/p&gt; &lt;p&gt;The positions are the layer &lt;i&gt;positions&lt;/i&gt; of &lt;i&gt;robot-bridge trajectories export drives.gpkg --site site&lt;/i&gt;, or any points, in any CRS, with a field for the robot and one for the time (date and time, seconds since 1970, or ISO 8601; without an offset UTC).&lt;/p&gt; &lt;p&gt;Fields: &lt;b&gt;begin&lt;/b&gt; and &lt;b&gt;end&lt;/b&gt; (UTC), &lt;b&gt;duration_s&lt;/b&gt;, &lt;b&gt;length_m&lt;/b&gt;, &lt;b&gt;mean_speed&lt;/b&gt; and &lt;b&gt;top_speed&lt;/b&gt; in m/s (as the robot told it, else its fastest step), &lt;b&gt;count&lt;/b&gt; of positions. The measure M of each vertex is its time in seconds since 1970. Lengths are measured in the layer's CRS if that is in true metres, as robots drive them, else on its ellipsoid.&lt;/p&gt; &lt;p&gt;The layer's times are set: open QGIS's temporal controller to play them.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:trajectories -- INPUT="drives.gpkg|layername=positions" OUTPUT=lines.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Hace de las posiciones que guardó una pasarela una línea para cada trayecto de cada robot: un robot del que no se supo nada durante más que el hueco empieza una línea nueva. O, con &lt;b&gt;una línea para cada paso&lt;/b&gt;, una para cada pareja de posiciones, para pintarlas según la velocidad y para el controlador temporal de QGIS.&lt;/p&gt; &lt;p&gt;Las posiciones son la capa &lt;i&gt;positions&lt;/i&gt; de &lt;i&gt;robot-bridge trajectories export drives.gpkg --site site&lt;/i&gt;, o cualesquiera puntos, en cualquier SRC, con un campo para el robot y uno para el tiempo (fecha y hora, segundos desde 1970, o ISO 8601; sin desfase UTC).&lt;/p&gt; &lt;p&gt;Campos: &lt;b&gt;begin&lt;/b&gt; y &lt;b&gt;end&lt;/b&gt; (UTC), &lt;b&gt;duration_s&lt;/b&gt;, &lt;b&gt;length_m&lt;/b&gt;, &lt;b&gt;mean_speed&lt;/b&gt; y &lt;b&gt;top_speed&lt;/b&gt; en m/s (como lo dijo el robot, si no su paso más rápido), &lt;b&gt;count&lt;/b&gt; de posiciones. La medida M de cada vértice es su tiempo en segundos desde 1970. Las longitudes se miden en el SRC de la capa si está en metros de verdad, como las recorren los robots, si no sobre su elipsoide.&lt;/p&gt; &lt;p&gt;Los tiempos de la capa están puestos: abra el controlador temporal de QGIS para reproducirlos.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:trajectories -- INPUT="drives.gpkg|layername=positions" OUTPUT=lines.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>A line for each step</source>
            <translation>Una línea para cada paso</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the robot</source>
            <translation>Campo del robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the speed [m/s]</source>
            <translation>Campo de la velocidad [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the time</source>
            <translation>Campo del tiempo</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Lines</source>
            <translation>Líneas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Longest gap in a line [s]</source>
            <translation>Hueco más largo en una línea [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Makes lines of stored positions, with their time, length and speed.</source>
            <translation>Hace líneas de las posiciones guardadas, con su tiempo, longitud y velocidad.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Metres driven, all robots</source>
            <translation>Metros recorridos, todos los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Positions</source>
            <translation>Posiciones</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>The positions have no field {name} for the {what}: they have {names}. Give the layer 'positions' of 'robot-bridge trajectories export', or say which field it is.</source>
            <translation>Las posiciones no tienen el campo {name} para: {what}; tienen {names}. Dé la capa 'positions' de 'robot-bridge trajectories export', o diga qué campo es.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Trajectories</source>
            <translation>Trayectorias</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>robot</source>
            <translation>robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>time</source>
            <translation>tiempo</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>{lines} of {positions}, {length:.1f} m in all.</source>
            <translation>{lines} de {positions}, {length:.1f} m en total.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>'x,y', or 'x,y [EPSG:4326]' in another CRS</source>
            <translation>'x,y', o 'x,y [EPSG:4326]' en otro SRC</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>'xmin,xmax,ymin,ymax'</source>
            <translation>'xmin,xmax,ymin,ymax'</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>It was cancelled before its end.</source>
            <translation>Se canceló antes de acabar.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>Robot maps</source>
            <translation>Mapas de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>There is no parameter {name}: correct it or leave it out. There are: {names}.</source>
            <translation>No hay ningún parámetro {name}: corríjalo u omítalo. Los que hay: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>a number</source>
            <translation>un número</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>one of {options}</source>
            <translation>uno de estos: {options}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>true or false</source>
            <translation>true o false</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name} is {value}: give {wanted}.</source>
            <translation>{name} es {value}: indique {wanted}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name}: the file {file} holds {count} layers ({layers}): say which, as in {file}|layername={first}.</source>
            <translation>{name}: el archivo {file} contiene {count} capas ({layers}): indique cuál, como en {file}|layername={first}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name}: the layer {layer} cannot be opened: check the file, and the layer's name after '|layername='.</source>
            <translation>{name}: la capa {layer} no se puede abrir: compruebe el archivo y el nombre de la capa después de '|layername='.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Classes of surface that are allowed, such as asphalt (default: all)</source>
            <translation>Clases de superficie permitidas, como asphalt (por defecto: todas)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Distance between cones [m]</source>
            <translation>Distancia entre conos [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Distance to obstacles [m]</source>
            <translation>Distancia a los obstáculos [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Layer {name}: {note}</source>
            <translation>Capa {name}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>No layer of surfaces is given: whether the cones stand on the road is not checked.</source>
            <translation>No se da ninguna capa de superficies: no se comprueba si los conos están en la vía.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>No surface is of class {classes}: the layers have {classes_there}.</source>
            <translation>No hay ninguna superficie de clase {classes}: las capas tienen {classes_there}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Nothing is wrong with the places of the cones.</source>
            <translation>No hay nada incorrecto en los lugares de los conos.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Obstacles to keep away from</source>
            <translation>Obstáculos de los que alejarse</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Site CRS, in metres (default: the project's, else the line's or the layer's)</source>
            <translation>SRC del recinto, en metros (por defecto: el del proyecto, si no el de la línea o la capa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Surfaces to stand on (default: not checked)</source>
            <translation>Superficies donde deben estar (por defecto: no se comprueba)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>The CRS of the site is not known: give SITE_CRS, such as EPSG:32633.</source>
            <translation>El SRC del recinto no se conoce: dé SITE_CRS, como EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>There are no findings: their layer is empty, and is not loaded.</source>
            <translation>No hay hallazgos: su capa está vacía y no se carga.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}, feature {id}</source>
            <translation>{layer}, objeto {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}: {field} is {value!r}, which is no number; correct it.</source>
            <translation>{layer}: {field} es {value!r}, que no es un número; corríjalo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}: {field} is {value:g}; give a whole number.</source>
            <translation>{layer}: {field} es {value:g}; dé un número entero.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{name}, feature {id}</source>
            <translation>{name}, objeto espacial {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{where} is not one point with a place on the site: correct or delete it.</source>
            <translation>{where} no es un solo punto con lugar en el recinto: corríjalo o bórrelo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. An outline that would cross itself stays as it is. Needs the Python package shapely 2.</source>
            <translation>0: desactivado. Un contorno que se cruzaría a sí mismo se queda como está. Necesita el paquete de Python shapely 2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. Ends of lines stay and rings keep three corners. Needs the Python package shapely 2.</source>
            <translation>0: desactivado. Los extremos de las líneas se quedan y los anillos conservan tres esquinas. Necesita el paquete de Python shapely 2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. Half a metre makes a compact map smaller still, and no obstacle lower than it is.</source>
            <translation>0: desactivado. Medio metro hace aún más pequeño un mapa compacto, y ningún obstáculo más bajo de lo que es.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>A whole map lies inside of {sources} and has no wall of it: maps hold walls alone, and do not say that a robot is in there. Choose a larger window or larger tiles.</source>
            <translation>Un mapa entero está dentro de {sources} y no tiene ninguna pared suya: los mapas solo contienen paredes y no dicen que un robot está dentro. Elija una ventana mayor o teselas mayores.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Bare map: no leading lines, no extras</source>
            <translation>Mapa escueto: sin líneas iniciales ni extras</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>DEFAULT_HEIGHT is {height}: give a number of metres of 0 or more.</source>
            <translation>DEFAULT_HEIGHT es {height}: dé un número de metros de 0 o más.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>DISSOLVE, TOLERANCE and SHORTEST need the Python package shapely 2, and {version} is installed here: install a newer one (python3 -m pip install 'shapely&gt;=2'), or leave them off.</source>
            <translation>DISSOLVE, TOLERANCE y SHORTEST necesitan el paquete de Python shapely 2, y aquí hay {version}: instale uno más nuevo (python3 -m pip install 'shapely&gt;=2'), o déjelos desactivados.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Fewer corners: how far an outline may then be from the drawn one [m]</source>
            <translation>Menos esquinas: a qué distancia puede quedar un contorno del dibujado [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Format (compact: binary in columns, about a third of binary)</source>
            <translation>Formato (compact: binario en columnas, un tercio del binario)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Heights are rounded up to a multiple of this [m]</source>
            <translation>Alturas redondeadas a un múltiplo de [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Join lines that meet end to end into one obstacle</source>
            <translation>Unir en un obstáculo las líneas que se tocan</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Leave out walls that no robot outside can meet</source>
            <translation>Omitir los muros que ningún robot encuentra fuera</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>No obstacle layer is given, and no layer of the project has a role of obstacles. Give OBSTACLES, roles (Fleet Supervisor &gt; Layer roles), or a PROFILE.</source>
            <translation>No se ha indicado ninguna capa de obstáculos, y ninguna capa del proyecto tiene un papel de obstáculo. Indique OBSTACLES, papeles (Fleet Supervisor &gt; Layer roles) o un PROFILE.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>OUTPUT {target} is the file of the layer {layer}: choose another one.</source>
            <translation>OUTPUT {target} es el archivo de la capa {layer}: elija otro.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Obstacle layers (default: those of the project with such a role)</source>
            <translation>Capas de obstáculos (por defecto: las del proyecto con ese papel)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Only lines that are alike in height, label and all else. The source of a joined line is that of its first part and how many others are in it, such as walls:3+7.</source>
            <translation>Solo líneas iguales en altura, etiqueta y todo lo demás. La fuente de una línea unida es la de su primera parte y cuántas más hay, como walls:3+7.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>PLANE_LOW is {low:g} and PLANE_HIGH {high:g}: give the lower and the upper height in metres.</source>
            <translation>PLANE_LOW es {low:g} y PLANE_HIGH {high:g}: dé la altura inferior y la superior en metros.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Reducing obstacles</source>
            <translation>Reduciendo obstáculos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Robot's plane from [m above the ground]</source>
            <translation>Plano del robot desde [m sobre el suelo]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Robot's plane up to [m above the ground]</source>
            <translation>Plano del robot hasta [m sobre el suelo]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Shortest segment: corners nearer than this to the one before are left out [m]</source>
            <translation>Segmento más corto: se omiten las esquinas más cercanas a la anterior [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>The layer {layer} is no vector layer: leave it out.</source>
            <translation>La capa {layer} no es vectorial: omítala.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>The robot map</source>
            <translation>El mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Those between buildings that touch, and lines inside or along buildings. What stays keeps its height and its source. Needs the Python package shapely 2.</source>
            <translation>Los de entre edificios que se tocan y las líneas dentro o a lo largo de edificios. Lo que queda conserva su altura y su origen. Necesita el paquete de Python shapely 2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>What begins at this height or above it is left out: the robot drives under it. Where things begin is said by the layers or by the parameter BASE_EXPRESSION.</source>
            <translation>Lo que empieza a esta altura o por encima se omite: el robot pasa por debajo. Dónde empiezan las cosas lo dicen las capas o el parámetro BASE_EXPRESSION.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>What is not higher than this is left out: the robot drives over it. Stairs and ramps stay. Give the lower and the upper height together, or neither.</source>
            <translation>Lo que no es más alto se omite: el robot pasa por encima. Escaleras y rampas se quedan. Dé la altura inferior y la superior juntas, o ninguna.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>binary: the text compressed</source>
            <translation>binario: el texto comprimido</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>compact: binary in columns</source>
            <translation>compacto: binario en columnas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>text</source>
            <translation>texto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>text: lines that people and scripts read. binary: that text compressed, with a check sum. compact: the same map in columns of centimetres, also with a check sum (codec 2).</source>
            <translation>text: líneas que leen personas y scripts. binary: ese texto comprimido, con suma de verificación. compact: el mismo mapa en columnas de centímetros, también con suma de verificación (códec 2).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{before} became {after}</source>
            <translation>antes: {before}; después: {after}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{name} is {value:g}: give a number of metres of 0 or more.</source>
            <translation>{name} es {value:g}: dé un número de metros de 0 o más.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{other} is given and {missing} is not: give both heights in metres, or none.</source>
            <translation>Se ha dado {other} y no {missing}: dé las dos alturas en metros, o ninguna.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>GeoJSON needs longitudes and latitudes, and the map's place is not known: give SITE_CRS, ORIGIN and ROTATION, or choose geopackage, which keeps the site's metres.</source>
            <translation>GeoJSON necesita longitudes y latitudes, y el lugar del mapa no se conoce: dé SITE_CRS, ORIGIN y ROTATION, o elija geopackage, que conserva los metros del recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>ORIGIN {origin} or ROTATION {rotation} is not finite: give numbers.</source>
            <translation>ORIGIN {origin} o ROTATION {rotation} no es finito: dé números.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Origin of the site frame in it (default: as the map says, else 0,0)</source>
            <translation>Origen del marco del recinto en él (por defecto: el que dice el mapa, si no 0,0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Robot map, text or binary</source>
            <translation>Mapa de robots, texto o binario</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Robot maps (*.txt *.map *.rmap *.bin);;All files (*)</source>
            <translation>Mapas de robots (*.txt *.map *.rmap *.bin);;Todos los archivos (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Rotation of the site frame, counter-clockwise [degrees] (default: as the map says, else 0)</source>
            <translation>Rotación del marco del recinto, en sentido antihorario [grados] (por defecto: la que dice el mapa, si no 0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Site CRS (default: as the map says)</source>
            <translation>SRC del recinto (por defecto: el que dice el mapa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The file {path} has {size} bytes, and a robot map at most {largest_text}: choose a map.</source>
            <translation>El archivo {path} tiene {size} bytes, y un mapa de robots como máximo {largest_text}: elija un mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The file {path} is no robot map: it is neither UTF-8 (byte {start}) nor in the binary format, which begins with {decode}. Choose another file.</source>
            <translation>El archivo {path} no es un mapa de robots: ni es UTF-8 (byte {start}) ni está en el formato binario, que empieza por {decode}. Elija otro archivo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The leading line '%{key} {meta}' of the map should hold {wanted}: correct it there, or give {parameter}.</source>
            <translation>La línea inicial '%{key} {meta}' del mapa debería contener {wanted}: corríjala allí, o dé {parameter}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The map's place is not known, because {why}: its layers are in local metres. Give SITE_CRS, ORIGIN and ROTATION to place it.</source>
            <translation>El lugar del mapa no se conoce, porque {why}: sus capas están en metros locales. Dé SITE_CRS, ORIGIN y ROTATION para situarlo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The map's positions cannot be transformed from {crs} to longitudes and latitudes ({error}): check the map's lines crs, origin and rotation.</source>
            <translation>Las posiciones del mapa no se pueden transformar de {crs} a longitudes y latitudes ({error}): compruebe las líneas crs, origin y rotation del mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The robot map {path} cannot be read: {error}</source>
            <translation>El mapa de robots {path} no se puede leer: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The robot map {path} cannot be read: {reason}. Check its rights.</source>
            <translation>El mapa de robots {path} no se puede leer: {reason}. Compruebe sus permisos.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>There is no file {file}: choose a robot map (MAP).</source>
            <translation>No hay ningún archivo {file}: elija un mapa de robots (MAP).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>it names no CRS</source>
            <translation>no nombra ningún SRC</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>the CRS {stated!r} that the map names is not known to QGIS</source>
            <translation>QGIS no conoce el SRC {stated!r} que el mapa nombra</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>two numbers 'x,y'</source>
            <translation>dos números 'x,y'</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>Layer {sourcename}, feature {id}</source>
            <translation>Capa {sourcename}, objeto espacial {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>Qt cannot draw the picture of this map: choose svg and open that in a browser.</source>
            <translation>Qt no puede dibujar la imagen de este mapa: elija svg y ábralo en un navegador.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>SPEED {text!r} is no expression ({reason}): write a field's name or a number.</source>
            <translation>SPEED {text!r} no es una expresión ({reason}): escriba el nombre de un campo o un número.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>The layer {name} of the GeoPackage cannot be written: {error}.</source>
            <translation>La capa {name} del GeoPackage no se puede escribir: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>has no speed above 0 m/s, so it sets no limit; it is left out</source>
            <translation>no tiene velocidad superior a 0 m/s, así que no limita; se omite</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>A layer cannot be written ({reason}): choose another place or format for it, and check the free space.</source>
            <translation>No se puede escribir una capa ({reason}): elija otro lugar o formato, y compruebe el espacio libre.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>it is there and is no file</source>
            <translation>ya existe y no es un archivo</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>no reason is given</source>
            <translation>no se da ningún motivo</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>the folder {folder} may not be written to</source>
            <translation>no se puede escribir en la carpeta {folder}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>there is no folder {folder}</source>
            <translation>no existe la carpeta {folder}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{path} is a folder, where a file is to be written: choose another OUTPUT.</source>
            <translation>{path} es una carpeta, donde se ha de escribir un archivo: elija otro OUTPUT.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{what} cannot be written to {folder}: {reason}. Choose a folder that may be written to, and check the free space.</source>
            <translation>{what} no se puede escribir en {folder}: {reason}. Elija una carpeta donde se pueda escribir, y compruebe el espacio libre.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{what} cannot be written to {target}: {reason}. Choose a file in a folder that exists, may be written to, and has space.</source>
            <translation>{what} no se puede escribir en {target}: {reason}. Elija un archivo en una carpeta que exista, donde se pueda escribir y que tenga espacio.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Both CENTER and EXTENT are given: give one of them, the window cannot be both.</source>
            <translation>Se han dado CENTER y EXTENT a la vez: dé uno, la ventana no puede ser ambos.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Centre of the window (or choose an extent)</source>
            <translation>Centro de la ventana (o elija una extensión)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Extent (instead of centre, width and height)</source>
            <translation>Extensión (en lugar de centro, anchura y altura)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Height of the window, along y [m]</source>
            <translation>Altura de la ventana, en y [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Layers without a CRS are in metres of the site</source>
            <translation>Las capas sin SRC están en metros del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Map profile ({kinds});;All files (*)</source>
            <translation>Perfil de mapa ({kinds});;Todos los archivos (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Map profile: what the layers are, by their names (default: as each layer keeps it)</source>
            <translation>Perfil de mapa: qué son las capas, por su nombre (por defecto: como lo guarda cada capa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Neither CENTER nor EXTENT is given: give the centre of the window with WIDTH and HEIGHT in metres, or an extent.</source>
            <translation>No se ha dado ni CENTER ni EXTENT: dé el centro de la ventana con WIDTH y HEIGHT en metros, o una extensión.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Origin of the site frame (default: as the project has it, else 0,0)</source>
            <translation>Origen del marco del recinto (por defecto: el del proyecto, si no 0,0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>ROTATION {degrees} is not finite: give a number.</source>
            <translation>ROTATION {degrees} no es finito: dé un número.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Rotation of the site frame, counter-clockwise from the CRS's x axis [degrees]</source>
            <translation>Rotación del marco del recinto, en sentido antihorario desde el eje x del SRC [grados]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>SITE_CRS {crs} is no CRS that QGIS knows: write a code such as EPSG:32633.</source>
            <translation>SITE_CRS {crs} no es un SRC que QGIS conozca: escriba un código como EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Site CRS, in metres (default: the project's, else the layers')</source>
            <translation>SRC del recinto, en metros (por defecto: el del proyecto, si no el de las capas)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>The layer {layer} is no vector layer: take its role away.</source>
            <translation>La capa {layer} no es vectorial: quítele el papel.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Width of the window, along x [m]</source>
            <translation>Anchura de la ventana, en x [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {extent} is no extent: write 'xmin,xmax,ymin,ymax'.</source>
            <translation>{name} {extent} no es una extensión: escriba 'xmin,xmax,ymin,ymax'.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {value} has no place in the CRS {crs}: give finite numbers, x or longitude first, and the CRS that they are in.</source>
            <translation>{name} {value} no tiene lugar en el SRC {crs}: dé números finitos, primero la x o la longitud, y el SRC en que están.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {value} is in the CRS {own}, which has no known relation to the CRS {crs}: give it in that one.</source>
            <translation>{name} {value} está en el SRC {own}, que no tiene relación conocida con el SRC {crs}: délo en este último.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{side} is {length}: give a finite number of metres.</source>
            <translation>{side} es {length}: dé un número finito de metros.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>The placed cones have no field {missing}: give a layer of a GeoPackage, or the CSV, that 'robot-bridge placements export' wrote.</source>
            <translation>Los conos colocados no tienen el campo {missing}: dé una capa de un GeoPackage, o el CSV, que haya escrito 'robot-bridge placements export'.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>There are no placed cones to report on. Check the filter of the layer, and the options of 'robot-bridge placements export'.</source>
            <translation>No hay conos colocados de los que informar. Compruebe el filtro de la capa y las opciones de 'robot-bridge placements export'.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>cones</source>
            <translation>conos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>deviation in cm</source>
            <translation>desviación en cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>last bar: up to {metres:.2f} m</source>
            <translation>última barra: hasta {metres:.2f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>tolerance {cm:.4g} cm</source>
            <translation>tolerancia {cm:.4g} cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A robot is lost without a message for [s]</source>
            <translation>Un robot está perdido sin mensaje durante [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A robot is stale without a message for [s]</source>
            <translation>Desactualizado sin mensaje durante [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A target is reached within [m]</source>
            <translation>Un objetivo se alcanza a menos de [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Database of the published site (PostGIS)</source>
            <translation>Base de datos del recinto publicado (PostGIS)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Folder of the published site</source>
            <translation>Carpeta del recinto publicado</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Height where none is known [m]</source>
            <translation>Altura donde no se conoce [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>It is not said where to publish: give FOLDER, a folder, or DATABASE, a PostgreSQL connection of QGIS's.</source>
            <translation>No se ha dicho dónde publicar: dé FOLDER, una carpeta, o DATABASE, una conexión PostgreSQL de QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Keepout layers (default: the project's with that role)</source>
            <translation>Capas de zonas prohibidas (por defecto: las del proyecto con ese papel)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Obstacle layers, stairs, ramps and furniture (default: the project's with such a role)</source>
            <translation>Capas de obstáculos, escaleras, rampas y mobiliario (por defecto: las del proyecto con ese papel)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Replace the publication of another site</source>
            <translation>Sustituir la publicación de otro recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Road centreline layers (default: the project's with that role)</source>
            <translation>Capas de ejes de vía (por defecto: las del proyecto con ese papel)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Road surface layers (default: the project's with that role)</source>
            <translation>Capas de superficies de vía (por defecto: las del proyecto con ese papel)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>SITE_ID is empty and the project has no variable {site_variable}: give the site an id of letters, digits, '_', '.' and '-', such as north_yard.</source>
            <translation>SITE_ID está vacío y el proyecto no tiene la variable {site_variable}: dé al recinto un id de letras, dígitos, '_', '.' y '-', como north_yard.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Site id (default: the project's)</source>
            <translation>Id del recinto (por defecto: el del proyecto)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Site name (default: the project's title)</source>
            <translation>Nombre del recinto (por defecto: el título del proyecto)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>The site's CRS is not known, and</source>
            <translation>El SRC del recinto no se conoce, y</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>The site's CRS, {crs_name},</source>
            <translation>El SRC del recinto, {crs_name},</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>There is nothing to publish: no layer is given and no layer of the project has a role. Give roles (Fleet Supervisor &gt; Layer roles), a PROFILE, or layers.</source>
            <translation>No hay nada que publicar: no se da ninguna capa y ninguna capa del proyecto tiene papel. Dé papeles (Fleet Supervisor &gt; Papeles de las capas), un PROFILE, o capas.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Where robots may be sent (default: all that is published)</source>
            <translation>Adónde se pueden enviar robots (por defecto: todo lo publicado)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Width of a road where none is known [m]</source>
            <translation>Anchura de una vía donde no se conoce [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{named} has no code that a gateway knows it by: choose SITE_CRS such as EPSG:32633. Layers in local metres can be published with ORIGIN and LOCAL=true.</source>
            <translation>{named} no tiene código por el que lo conozca una pasarela: elija SITE_CRS, como EPSG:32633. Las capas en metros locales se pueden publicar con ORIGIN y LOCAL=true.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{name} is {value}: give a number of metres above 0.</source>
            <translation>{name} es {value}: dé un número de metros superior a 0.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{place} = {text} is no number: correct it there.</source>
            <translation>{place} = {text} no es un número: corríjalo allí.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{title} (default: as published, at first {default:g})</source>
            <translation>{title} (por defecto: como se publicó, al principio {default:g})</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>E and N in metres of {crs}; {mark} beyond the tolerance of {tolerance:g} cm</source>
            <translation>E y N en metros de {crs}; {mark} fuera de la tolerancia de {tolerance:g} cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Mean {mean}, RMS {rms}, 95 % within {p95}, largest {most}.</source>
            <translation>Media {mean}, RMS {rms}, 95 % dentro de {p95}, máxima {most}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Off cm</source>
            <translation>Desv. cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Placed (UTC)</source>
            <translation>Colocado (UTC)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Planned E</source>
            <translation>Planificado E</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Planned N</source>
            <translation>Planificado N</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>QGIS cannot make the report (layout export {number}): check the free space, and the background layers by leaving them out.</source>
            <translation>QGIS no puede hacer el informe (exportación de la composición: {number}): compruebe el espacio libre, y las capas de fondo quitándolas.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Robots: {names}</source>
            <translation>Robots: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>The report</source>
            <translation>El informe</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>{first} to {last} UTC</source>
            <translation>de {first} a {last} UTC</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>{time} UTC</source>
            <translation>{time} UTC</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>{within} of %n cones ({share:.0f} %) stand within {tolerance:g} cm of their plan.</source>
            <translation>
                <numerusform>{within} de %n cono ({share:.0f} %) está a menos de {tolerance:g} cm del plan.</numerusform>
                <numerusform>{within} de %n conos ({share:.0f} %) están a menos de {tolerance:g} cm del plan.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>× planned   ● placed (red: beyond the tolerance)   orange: deviation</source>
            <translation>× planificado   ● colocado (rojo: fuera de la tolerancia)   naranja: desviación</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>× planned   ● placed (red: beyond the tolerance)   orange: deviation, {factor} times as long</source>
            <translation>× planificado   ● colocado (rojo: fuera de la tolerancia)   naranja: desviación, {factor} veces más larga</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>ΔE cm</source>
            <translation>ΔE cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>ΔN cm</source>
            <translation>ΔN cm</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>%n edges lead through areas to be avoided, and are closed</source>
            <translation>
                <numerusform>%n arista pasa por zonas que hay que evitar, y se cierra</numerusform>
                <numerusform>%n aristas pasan por zonas que hay que evitar, y se cierran</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Areas that must not be driven through</source>
            <translation>Zonas que no se deben atravesar</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>CRS in metres (default: the layer's, or the project's)</source>
            <translation>SRC en metros (por defecto: el de la capa o el del proyecto)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Direction: yes along the line, -1 against it, no both (default: a field oneway, ...)</source>
            <translation>Sentido: yes a lo largo de la línea, -1 en contra, no ambos (por defecto: un campo oneway, ...)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Ends this near to a road were meant to meet it [m]</source>
            <translation>Extremos así de cerca de una vía la tocan [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Farthest place from a road [m]</source>
            <translation>Distancia máxima a una vía [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Layer {name}, feature {id}: {note}</source>
            <translation>Capa {name}, objeto espacial {id}: {note}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Layer {name}: the width of %n roads is not known; {width:g} m is used</source>
            <translation>
                <numerusform>Capa {name}: la anchura de %n vía no se conoce; se usa {width:g} m</numerusform>
                <numerusform>Capa {name}: la anchura de %n vías no se conoce; se usa {width:g} m</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Level of each road, 0 on the ground (default: fields level, layer, bridge, tunnel)</source>
            <translation>Nivel de cada vía, 0 en el suelo (por defecto: campos level, layer, bridge, tunnel)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>No road has the surface {surfaces}: the roads have {there}.</source>
            <translation>Ninguna vía tiene la superficie {surfaces}: las vías tienen {there}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Points of the path at most this far apart [m]</source>
            <translation>Puntos del camino separados como máximo [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS {roads} cannot be opened: check the file and the layer's name.</source>
            <translation>ROADS {roads} no se puede abrir: compruebe el archivo y el nombre de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS: no feature of the layer {name} is a road: each has to be a line with a length that the layer's filter keeps. {first}</source>
            <translation>ROADS: ningún elemento de la capa {name} es una vía: cada uno debe ser una línea con longitud que el filtro de la capa conserve. {first}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS: the layer {name} has no features: choose the layer of the road centrelines.</source>
            <translation>ROADS: la capa {name} no tiene elementos: elija la capa de los ejes de vía.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Repair: close gaps, cut overshoots, leave out what is drawn twice</source>
            <translation>Reparar: cerrar huecos, cortar sobrepasos, omitir lo dibujado dos veces</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Repaired: {kind} of feature {feature} at {where}: {text}</source>
            <translation>Reparado: {kind} del objeto {feature} en {where}: {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Roads at least this wide, and as wide as the robot [m]</source>
            <translation>Vías al menos así de anchas, y tanto como el robot [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Speed on each road [m/s] (default: a field speed_ms, or maxspeed in km/h)</source>
            <translation>Velocidad en cada vía [m/s] (por defecto: un campo speed_ms, o maxspeed en km/h)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Speed on roads of which it is not known [m/s]</source>
            <translation>Velocidad en las vías de las que no se conoce [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Surface of each road (default: the layer's role, else a field surface)</source>
            <translation>Superficie de cada vía (por defecto: el papel de la capa, si no un campo surface)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Surfaces that may be used (default: all)</source>
            <translation>Superficies que se pueden usar (por defecto: todas)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>The filter of its role keeps none of them.</source>
            <translation>El filtro de su papel no conserva ninguno.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Turning radius of the robot [m]</source>
            <translation>Radio de giro del robot [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Whether each road is closed (default: a field closed)</source>
            <translation>Si cada vía está cerrada (por defecto: un campo closed)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of each road [m] (default: the layer's role, else a field width_m or width)</source>
            <translation>Anchura de cada vía [m] (por defecto: el papel de la capa, si no un campo width_m o width)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of roads of which it is not known [m]</source>
            <translation>Anchura de las vías de las que no se conoce [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of the robot [m]</source>
            <translation>Anchura del robot [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Only the first {count} positions were fetched. Choose less time, or fewer robots.</source>
            <translation>Solo se obtuvieron las primeras {count} posiciones. Elija menos tiempo o menos robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Putting positions in order</source>
            <translation>Ordenando las posiciones</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Stopped: the rest of the time was not fetched.</source>
            <translation>Detenido: no se obtuvo el resto del tiempo.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>The gateway's answer cannot be used: {error}.</source>
            <translation>La respuesta de la pasarela no se puede usar: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>The rest of the time was not fetched: {error}</source>
            <translation>No se obtuvo el resto del tiempo: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>What came could not be put in order.</source>
            <translation>Lo que llegó no se pudo ordenar.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>{robot}: {command} · {state} by {by}</source>
            <translation>{robot}: {command} · {state} por {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source> · NOT ALL</source>
            <translation> · NO TODAS</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Choose a time and press Load.</source>
            <translation>Elija un tiempo y pulse Cargar.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>How much faster than it was</source>
            <translation>Cuánto más rápido que como fue</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Loading …</source>
            <translation>Cargando …</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Loading … {positions}, up to {moment}</source>
            <translation>Cargando … {positions}, hasta {moment}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>No positions are stored of that time.</source>
            <translation>No hay posiciones guardadas de ese tiempo.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>No robot is selected to be replayed. Select one, or replay all.</source>
            <translation>No hay ningún robot seleccionado para reproducir. Seleccione uno o reproduzca todos.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Play what robots did, on a map beside the live one</source>
            <translation>Reproducir lo que hicieron los robots, en un mapa junto al que está en vivo</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Play, or hold (Space)</source>
            <translation>Reproducir o detener (Espacio)</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>REPLAY · {status}</source>
            <translation>REPRODUCCIÓN · {status}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>REPLAY, not live · {moment} · {status}</source>
            <translation>REPRODUCCIÓN, no en vivo · {moment} · {status}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Replay</source>
            <translation>Reproducción</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>The replay was not loaded: {error}</source>
            <translation>La reproducción no se cargó: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>The replay's time ends before it begins. Correct one of the two.</source>
            <translation>El tiempo de la reproducción acaba antes de empezar. Corrija uno de los dos.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>There is nothing to replay yet. Connect to a gateway first.</source>
            <translation>Aún no hay nada que reproducir. Conéctese primero a una pasarela.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>positions: {positions}, robots: {robots}</source>
            <translation>posiciones: {positions}, robots: {robots}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Drawing what robots drove</source>
            <translation>Dibujando lo que recorrieron los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Not all trajectories are drawn: {error}</source>
            <translation>No se dibujaron todas las trayectorias: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>The trajectories are not drawn: they could not be made into lines.</source>
            <translation>Las trayectorias no se dibujaron: no se pudieron convertir en líneas.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Trajectories (replay)</source>
            <translation>Trayectorias (reproducción)</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>From</source>
            <translation>Desde</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>From when on</source>
            <translation>Desde cuándo</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Load</source>
            <translation>Cargar</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Load what the selected robots did, not what all did</source>
            <translation>Cargar lo que hicieron los robots seleccionados, no lo de todos</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Selected only</source>
            <translation>Solo los seleccionados</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>To</source>
            <translation>Hasta</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Until when</source>
            <translation>Hasta cuándo</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>from … to …</source>
            <translation>de … a …</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 15 minutes</source>
            <translation>los últimos 15 minutos</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 5 minutes</source>
            <translation>los últimos 5 minutos</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 8 hours</source>
            <translation>las últimas 8 horas</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last hour</source>
            <translation>la última hora</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>%n connections from {file}.</source>
            <translation>
                <numerusform>%n conexión de {file}.</numerusform>
                <numerusform>%n conexiones de {file}.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>%n connections in {file}, without tokens.</source>
            <translation>
                <numerusform>%n conexión en {file}, sin testigo.</numerusform>
                <numerusform>%n conexiones en {file}, sin testigos.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Authentication</source>
            <translation>&amp;Autenticación</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Edit…</source>
            <translation>&amp;Editar…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Import…</source>
            <translation>&amp;Importar…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;New…</source>
            <translation>&amp;Nueva…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Operator</source>
            <translation>&amp;Operador</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Remove</source>
            <translation>&amp;Quitar</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Test</source>
            <translation>&amp;Probar</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Token</source>
            <translation>&amp;Testigo</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>CA &amp;file</source>
            <translation>A&amp;rchivo de CA</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connecting to {name} …</source>
            <translation>Conectando a {name} …</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connecting …</source>
            <translation>Conectando …</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connections (*.json)</source>
            <translation>Conexiones (*.json)</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connections to gateways</source>
            <translation>Conexiones a pasarelas</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>E&amp;xport…</source>
            <translation>E&amp;xportar…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Edit connection</source>
            <translation>Editar conexión</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Export connections</source>
            <translation>Exportar conexiones</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Gateway</source>
            <translation>Pasarela</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Import connections</source>
            <translation>Importar conexiones</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Name</source>
            <translation>Nombre</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>New connection</source>
            <translation>Conexión nueva</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Press New… for a gateway, or Import… for those that another computer has exported.</source>
            <translation>Pulse Nueva… para una pasarela, o Importar… para las que ha exportado otro ordenador.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Removed: {names}. Tokens stay in QGIS's authentication.</source>
            <translation>Quitado: {names}. Los testigos se quedan en la autenticación de QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Replaced: {replaced}.</source>
            <translation>Sustituidas: {replaced}.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>T&amp;est</source>
            <translation>&amp;Probar</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>There is a connection {name} already. Give this one another name.</source>
            <translation>Ya hay una conexión {name}. Dé otro nombre a esta.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>connection test</source>
            <translation>prueba de conexión</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>kept by QGIS, encrypted; or choose one below</source>
            <translation>lo guarda QGIS, cifrado; o elija uno abajo</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>such as the site's name</source>
            <translation>como el nombre del recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>who you are, in every log</source>
            <translation>quién es usted, en cada registro</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{file} cannot be written: {error}</source>
            <translation>{file} no se puede escribir: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{site} ({crs}) answers, as {who}.</source>
            <translation>{site} ({crs}) responde, como {who}.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{site} ({crs}) answers.</source>
            <translation>{site} ({crs}) responde.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>Choose a file that Export wrote.</source>
            <translation>Elija un archivo que haya escrito Exportar.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>QGIS did not give the token that it keeps: its master password was not given. Press Connect and enter it, or enter the token under Access.</source>
            <translation>QGIS no dio el testigo que guarda: no se dio su contraseña maestra. Pulse Conectar e introdúzcala, o introduzca el testigo en Acceso.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>QGIS did not keep the token: its master password was not given. The token is used now and has to be entered again next time.</source>
            <translation>QGIS no guardó el testigo: no se dio su contraseña maestra. El testigo se usa ahora y habrá que introducirlo otra vez la próxima vez.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The authentication {config} is of the method {method}, which gateways do not know. Choose one of the method {wanted} with the token as its password.</source>
            <translation>La autenticación {config} es del método {method}, que las pasarelas no conocen. Elija una del método {wanted} con el testigo como contraseña.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The authentication {config} that the connection names is not in this QGIS. Edit the connection and choose another, or enter the token.</source>
            <translation>La autenticación {config} que nombra la conexión no está en este QGIS. Edite la conexión y elija otra, o introduzca el testigo.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The connection has no name. Give it one, such as the site's.</source>
            <translation>La conexión no tiene nombre. Dele uno, como el del recinto.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>This QGIS keeps no authentication (its options say why, under Authentication): enter the token under Access.</source>
            <translation>Este QGIS no guarda autenticación (sus opciones dicen por qué, en Autenticación): introduzca el testigo en Acceso.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} has no list named connections. {choose}</source>
            <translation>{source} no tiene ninguna lista llamada connections. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} holds no connections to gateways. {choose}</source>
            <translation>{source} no contiene conexiones a pasarelas. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} is not JSON: {error}. {choose}</source>
            <translation>{source} no es JSON: {error}. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} is of version {found}; this plugin reads version {version}. Update the plugin.</source>
            <translation>{source} es de la versión {found}; este complemento lee la versión {version}. Actualice el complemento.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source}: connection {number} is not a set of texts named {keys}. {choose}</source>
            <translation>{source}: la conexión {number} no es un conjunto de textos llamados {keys}. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source}: connection {number}: {error}</source>
            <translation>{source}: conexión {number}: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice fleet ended: {why}. Start it again; if that fails, see what {program} says by hand.</source>
            <translation>La flota de práctica terminó: {why}. Arránquela otra vez; si falla, vea qué dice {program} a mano.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice fleet needs robot-bridge, which is not on this computer. In a terminal, in the project's folder: python3 -m venv gateway, then gateway/bin/pip install . and put gateway/bin on PATH; or make setup. Then restart QGIS. The tour can be read without it.</source>
            <translation>La flota de práctica necesita robot-bridge, que no está en este ordenador. En un terminal, en la carpeta del proyecto: python3 -m venv gateway, después gateway/bin/pip install . y ponga gateway/bin en el PATH; o make setup. Después reinicie QGIS. El recorrido se puede leer sin él.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice robot {robot} does not run: {why}. Close the tour and start the practice fleet again; if that fails, see what {program} says by hand.</source>
            <translation>El robot de práctica {robot} no funciona: {why}. Cierre el recorrido y arranque otra vez la flota de práctica; si falla, vea qué dice {program} a mano.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>it ended with code {code}</source>
            <translation>terminó con el código {code}</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Back</source>
            <translation>&amp;Atrás</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Finish</source>
            <translation>&amp;Finalizar</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Next</source>
            <translation>&amp;Siguiente</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>A five-minute tour shows how it works.</source>
            <translation>Un recorrido de cinco minutos muestra cómo funciona.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>A site is an ordinary QGIS project: an orthophoto, roads, obstacles, each layer with a role. Open the sample site; QGIS asks first if your own project is not saved.</source>
            <translation>Un recinto es un proyecto de QGIS corriente: una ortofoto, vías, obstáculos, cada capa con un papel. Abra el recinto de ejemplo; QGIS pregunta antes si su proyecto no está guardado.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Abort robot: the selected robots give up their task. ABORT ALL: every robot does. EMERGENCY STOP (F10): every robot stops now, and none can be sent anywhere until a supervisor clears it.</source>
            <translation>Abortar robot: los robots seleccionados abandonan su tarea. ABORTAR TODO: todos. PARADA DE EMERGENCIA (F10): todos los robots se detienen ahora, y ninguno se puede enviar a ningún sitio hasta que un supervisor lo levante.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>An arrow shows where a robot heads, its colour and shape the state. Hold the mouse over one for its card; with Select robot a click selects, a rectangle selects several, a double click goes there.</source>
            <translation>Una flecha muestra hacia dónde mira un robot, su color y forma el estado. Deje el ratón encima para ver su ficha; con Seleccionar robot un clic selecciona, un rectángulo selecciona varios, un doble clic va allí.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>C&amp;lose</source>
            <translation>&amp;Cerrar</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Click r1: it is selected on the map, too.</source>
            <translation>Haga clic en r1: también queda seleccionado en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Closing it ends the practice fleet. What else the desk does is in the operator's guide, docs/operator.md; how real robots are connected in docs/integrator.md.</source>
            <translation>Al cerrarlo termina la flota de práctica. Qué más hace la consola está en la guía del operador, docs/operator.md; cómo se conectan robots reales, en docs/integrator.md.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Cone target, a click on the map, Enter: that sends the selected robot. Before that it is a draft, checked against the site; Esc takes it away, and nothing was sent.</source>
            <translation>Objetivo de cono, un clic en el mapa, Intro: eso envía el robot seleccionado. Antes es un borrador, comprobado con el recinto; Esc lo quita, y no se envió nada.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Each robot has a row: its state, its task, its battery, and how old its last message is. A robot that falls silent is stale, then lost; it stays on the map, marked.</source>
            <translation>Cada robot tiene una fila: su estado, su tarea, su batería, y la edad de su último mensaje. Un robot que calla queda desactualizado, después perdido; se queda en el mapa, marcado.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Every command is here with each of its steps: queued, delivered, acknowledged, reached; or why it failed. A double click shows its place on the map.</source>
            <translation>Aquí está cada orden con todos sus pasos: en cola, entregada, reconocida, alcanzada; o por qué falló. Un doble clic muestra su lugar en el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Five minutes with a practice fleet</source>
            <translation>Cinco minutos con una flota de práctica</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Here stand the gateway's address and your name, which every log shows. For a real fleet write them and press Connect. For the tour, start the practice fleet: it connects by itself.</source>
            <translation>Aquí están la dirección de la pasarela y su nombre, que muestran todos los registros. Para una flota real escríbalos y pulse Conectar. Para el recorrido, arranque la flota de práctica: se conecta sola.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Open the sample site</source>
            <translation>Abrir el recinto de ejemplo</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Send a robot</source>
            <translation>Enviar un robot</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Start the practice fleet</source>
            <translation>Arrancar la flota de práctica</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Start the tour</source>
            <translation>Empezar el recorrido</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Starting …</source>
            <translation>Arrancando …</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>That was the tour</source>
            <translation>Ese era el recorrido</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The desk is connected to another gateway. Disconnect first: the tour moves no real robots.</source>
            <translation>La consola está conectada a otra pasarela. Desconéctela antes: el recorrido no mueve robots reales.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The link</source>
            <translation>El enlace</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The map</source>
            <translation>El mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The practice fleet runs, and the desk is connected to it.</source>
            <translation>La flota de práctica funciona, y la consola está conectada a ella.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The robots</source>
            <translation>Los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The sample site is open.</source>
            <translation>El recinto de ejemplo está abierto.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The sample site was not opened: {path}.</source>
            <translation>El recinto de ejemplo no se abrió: {path}.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The site</source>
            <translation>El recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The tour needs no network: a gateway and three simulated robots run on this computer, and nothing real moves. Next and Back lead on, Esc closes. It is in the menu Plugins &gt; Fleet Supervisor &gt; Tour.</source>
            <translation>El recorrido no necesita red: una pasarela y tres robots simulados funcionan en este ordenador, y nada real se mueve. Siguiente y Atrás llevan por él, Esc lo cierra. Está en el menú Complementos &gt; Fleet Supervisor &gt; Recorrido guiado.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Tour</source>
            <translation>Recorrido guiado</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Try it: only practice robots stop. Then clear it in the red banner.</source>
            <translation>Pruébelo: solo se detienen robots de práctica. Después levántela en la franja roja.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Try it: press Cone target, click on the road near r1, then Enter.</source>
            <translation>Pruébelo: pulse Objetivo de cono, haga clic en la vía cerca de r1, e Intro.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>What became of it</source>
            <translation>Qué fue de ello</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Abort robot</source>
            <translation>Abortar robot</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Add to queue</source>
            <translation>Añadir a la cola</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Clear emergency stop…</source>
            <translation>Levantar la parada de emergencia…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Close a road for every robot by a click on it, or open a closed one again</source>
            <translation>Cerrar una vía a todos los robots con un clic, o volver a abrir una cerrada</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Cone target</source>
            <translation>Objetivo de cono</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Connect to the gateway, or disconnect</source>
            <translation>Conectar a la pasarela, o desconectar</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Continue</source>
            <translation>Continuar</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Coordinates…</source>
            <translation>Coordenadas…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Draw a route for the selected robot: click its points, right click ends drawing, drag points or lines to change it, Backspace takes the last one back, Enter or Send sends, Esc cancels</source>
            <translation>Dibujar una ruta para el robot seleccionado: haga clic en sus puntos, el clic derecho termina el dibujo, arrastre puntos o líneas para cambiarla, Retroceso quita el último, Intro o Enviar la envía, Esc cancela</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Draw route</source>
            <translation>Dibujar ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every robot gives up its task, at once and without a question</source>
            <translation>Todos los robots abandonan su tarea, al instante y sin preguntar</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every robot stops now, and none can be sent anywhere until a supervisor clears it ({one_key} or {other_key})</source>
            <translation>Todos los robots se detienen ahora, y ninguno se puede enviar a ningún sitio hasta que un supervisor lo levante ({one_key} o {other_key})</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every selected robot gives up its task at once</source>
            <translation>Cada robot seleccionado abandona su tarea al instante</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every selected robot stands at once and keeps its task, until it is let go on with Continue</source>
            <translation>Cada robot seleccionado se detiene al instante y conserva su tarea, hasta que se le deja seguir con Continuar</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Fleet panel</source>
            <translation>Panel de la flota</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Follow</source>
            <translation>Seguir</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep all in view</source>
            <translation>Todos a la vista</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep every robot in view</source>
            <translation>Mantener a la vista todos los robots</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep the selected robots in view</source>
            <translation>Mantener a la vista los robots seleccionados</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let a draft be sent in spite of what the checks found; asks why</source>
            <translation>Permitir enviar un borrador a pesar de lo que hallaron las comprobaciones; pregunta por qué</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let robots be sent again; takes a supervisor, and asks first</source>
            <translation>Permitir enviar robots otra vez; hace falta un supervisor, y antes pregunta</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let the route begin at its end; R over the map does so too</source>
            <translation>Hacer que la ruta empiece por el final; R sobre el mapa también lo hace</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let the selected robots that are paused go on with their tasks, from where they stand</source>
            <translation>Deja que los robots seleccionados que están en pausa sigan con sus tareas, desde donde están</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Make the change again that was taken back; Ctrl+Shift+Z over the map does so too</source>
            <translation>Volver a hacer el cambio deshecho; Ctrl+Mayús+Z sobre el mapa también lo hace</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Make the draft of what is selected in the active layer: a point, a line, or many points</source>
            <translation>Hacer el borrador con lo seleccionado en la capa activa: un punto, una línea o muchos puntos</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Pause robot</source>
            <translation>Pausar robot</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Put what is drawn at the end of its robot's queue, instead of sending it</source>
            <translation>Poner lo dibujado al final de la cola de su robot, en lugar de enviarlo</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Redo</source>
            <translation>Rehacer</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Route along the roads for the selected robot: the way to the mouse is shown, a click takes it, right click ends drawing; Backspace takes the last leg back, Enter or Send sends, Esc cancels</source>
            <translation>Ruta por vías para el robot seleccionado: se muestra el recorrido hasta el ratón, un clic lo toma, el clic derecho termina el dibujo; Retroceso quita el último tramo, Intro o Enviar la envía, Esc cancela</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Say how Route on roads is to lead: shortest or fastest, on which surfaces, off the roads of other robots</source>
            <translation>Diga cómo debe llevar la Ruta por vías: la más corta o la más rápida, por qué superficies, fuera de las vías de otros robots</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Select robot</source>
            <translation>Seleccionar robot</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Select robots on the map: click one or drag a rectangle, with Shift to add, with Ctrl to take away; double click goes there</source>
            <translation>Seleccionar robots en el mapa: haga clic en uno o arrastre un rectángulo, con Mayús para añadir, con Ctrl para quitar; el doble clic va allí</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send map</source>
            <translation>Enviar mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send the selected robots the map of the whole site now</source>
            <translation>Enviar ahora a los robots seleccionados el mapa de todo el recinto</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send what is drawn on the map to its robot</source>
            <translation>Enviar a su robot lo dibujado en el mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Set a cone target for the selected robot: click, then Enter or Send; Esc cancels</source>
            <translation>Poner un objetivo de cono para el robot seleccionado: clic, y después Intro o Enviar; Esc cancela</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Show or hide the fleet panel</source>
            <translation>Mostrar u ocultar el panel de la flota</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Start position</source>
            <translation>Posición inicial</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take from layer</source>
            <translation>De la capa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take the last change of the draft back; Ctrl+Z over the map does so too</source>
            <translation>Deshacer el último cambio del borrador; Ctrl+Z sobre el mapa también lo hace</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take what is drawn off the map; nothing is sent</source>
            <translation>Quitar del mapa lo dibujado; no se envía nada</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Tell the selected robot where it stands: click, or drag to where it points; then Enter or Send</source>
            <translation>Decir al robot seleccionado dónde está: clic, o arrastre hacia donde mira; después Intro o Enviar</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Turn route round</source>
            <translation>Invertir ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Type or paste coordinates in any CRS in place of a click</source>
            <translation>Escribir o pegar coordenadas en cualquier SRC en lugar de un clic</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Undo</source>
            <translation>Deshacer</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Ways on roads…</source>
            <translation>Caminos por vías…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>{key} is the key of the EMERGENCY STOP and does not perform {action}. Give that another key in Settings &gt; Keyboard Shortcuts.</source>
            <translation>{key} es la tecla de la PARADA DE EMERGENCIA y no ejecuta {action}. Dele otra tecla en Configuración &gt; Atajos de teclado.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/language.py" />
            <source>{state}, last heard {age} ago over {link}</source>
            <translation>{state}, último mensaje hace {age} por {link}</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/scheduling.py" />
            <source>a fault of the plugin: {error}. View &gt; Panels &gt; Log Messages says where: report it.</source>
            <translation>un fallo del complemento: {error}. Ver &gt; Paneles &gt; Mensajes de registro dice dónde: infórmelo.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/tables.py" />
            <source>{file} was not written ({why}). Choose another folder, or close the file where it is open.</source>
            <translation>{file} no se escribió ({why}). Elija otra carpeta, o cierre el archivo donde esté abierto.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/vendored.py" />
            <source>The Python package websockets is missing, which the connection to the gateway needs. Install the plugin from its release zip, which contains it, or run 'python3 -m pip install websockets' with the Python that QGIS uses, and restart QGIS.</source>
            <translation>Falta el paquete de Python websockets, que necesita la conexión con la pasarela. Instale el complemento desde el zip publicado, que lo contiene, o ejecute 'python3 -m pip install websockets' con el Python de QGIS, y reinicie QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/vendored.py" />
            <source>The Python package websockets {version} in {path} is too old for the connection to the gateway. Install the plugin from its release zip, which contains a newer one, or run 'python3 -m pip install "websockets&gt;={oldest}"' with the Python that QGIS uses, and restart QGIS.</source>
            <translation>El paquete de Python websockets {version} en {path} es demasiado antiguo para la conexión con la pasarela. Instale el complemento desde el zip publicado, que contiene uno más nuevo, o ejecute 'python3 -m pip install "websockets&gt;={oldest}"' con el Python de QGIS, y reinicie QGIS.</translation>
        </message>
    </context>
</TS>
