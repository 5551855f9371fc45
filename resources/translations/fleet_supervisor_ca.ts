<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ca" sourcelanguage="en">
    <context>
        <name>FleetSupervisor</name>
        <message numerus="yes">
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>%n accounts</source>
            <translation>
                <numerusform>%n compte</numerusform>
                <numerusform>%n comptes</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Add…</source>
            <translation>&amp;Afegeix…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Name</source>
            <translation>&amp;Nom</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Role</source>
            <translation>&amp;Rol</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Token holds</source>
            <translation>El &amp;testimoni val</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Accounts</source>
            <translation>Comptes</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Accounts…</source>
            <translation>Comptes…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Cancel</source>
            <translation>Cancel·la</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Change &amp;role…</source>
            <translation>Canvia el &amp;rol…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Change role</source>
            <translation>Canvia el rol</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Last connected</source>
            <translation>Última connexió</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Make account</source>
            <translation>Fes el compte</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Make token</source>
            <translation>Fes el testimoni</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New &amp;token…</source>
            <translation>&amp;Testimoni nou…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New account</source>
            <translation>Compte nou</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New account {operator}</source>
            <translation>Compte nou: {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New token for {operator}</source>
            <translation>Testimoni nou per a {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Operator</source>
            <translation>Operador</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Re&amp;fresh</source>
            <translation>Act&amp;ualitza</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Re&amp;voke…</source>
            <translation>Re&amp;voca…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke</source>
            <translation>Revoca</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke the token of {operator}?</source>
            <translation>Revocar el testimoni de {operator}?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke {operator}</source>
            <translation>Revocació de {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Role</source>
            <translation>Paper</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Role of {operator}</source>
            <translation>Rol de {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Since</source>
            <translation>Des de</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The gateway makes a token for the account. It is shown once, to be handed over.</source>
            <translation>La passarel·la fa un testimoni per al compte. Es mostra un sol cop, per lliurar-lo.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} ends at once, with every connection that it opened. The account stays, and a new token can be made for it. Robots go on with what they were told.</source>
            <translation>El testimoni de {operator} s'acaba de seguida, amb totes les connexions que ha obert. El compte es queda, i se li pot fer un testimoni nou. Els robots continuen amb el que se'ls ha dit.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} is made.</source>
            <translation>S'ha fet el testimoni de {operator}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} is revoked.</source>
            <translation>S'ha revocat el testimoni de {operator}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This gateway has no accounts yet: everybody on its computer may do everything. The first account ends that for good, and this connection too: connect again with its token. It has to be a supervisor's.</source>
            <translation>Aquesta passarel·la encara no té comptes: tothom al seu ordinador ho pot fer tot. El primer compte hi posa fi per sempre, i també a aquesta connexió: torneu-vos a connectar amb el seu testimoni. Ha de ser d'un supervisor.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This gateway has no accounts: everybody on its computer may do everything. The first account, a supervisor's, ends that.</source>
            <translation>Aquesta passarel·la no té comptes: tothom al seu ordinador ho pot fer tot. El primer compte, d'un supervisor, hi posa fi.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: this desk is cut off and does not come back by itself.</source>
            <translation>Aquest és el vostre compte: aquesta consola queda desconnectada i no torna tota sola.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: this desk is cut off until you enter the new token.</source>
            <translation>Aquest és el vostre compte: aquesta consola queda desconnectada fins que introduïu el testimoni nou.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: without being a supervisor you cannot undo it.</source>
            <translation>Aquest és el vostre compte: sense ser supervisor no ho podreu desfer.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Token</source>
            <translation>Testimoni</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Who may connect to the gateway and do what; takes a supervisor</source>
            <translation>Qui es pot connectar a la passarel·la i què pot fer; cal un supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>connected now</source>
            <translation>connectat ara</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>expired {time}</source>
            <translation>caducat: {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 1 day</source>
            <translation>durant 1 dia</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 1 year</source>
            <translation>durant 1 any</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 30 days</source>
            <translation>durant 30 dies</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 7 days</source>
            <translation>durant 7 dies</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 90 days</source>
            <translation>durant 90 dies</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>holds until {time}</source>
            <translation>vàlid fins a {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>none</source>
            <translation>cap</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>revoked {time}</source>
            <translation>revocat: {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>until it is revoked</source>
            <translation>fins que es revoqui</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} (you)</source>
            <translation>{operator} (vós)</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} gets a new token. The one before ends at once, with every connection that it opened.</source>
            <translation>{operator} rep un testimoni nou. L'anterior s'acaba de seguida, amb totes les connexions que ha obert.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} is {role} now.</source>
            <translation>Ara el rol de {operator} és {role}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} is {role}. Another role holds from the next thing on that is asked for, also over connections that are open.</source>
            <translation>El rol de {operator} és {role}. Un altre rol val a partir de la petició següent, també en connexions obertes.</translation>
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
                <numerusform>%n robot no s'ha eliminat: {why}</numerusform>
                <numerusform>%n robots no s'han eliminat: {why}</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>%n robots were removed: {names}</source>
            <translation>
                <numerusform>%n robot eliminat: {names}</numerusform>
                <numerusform>%n robots eliminats: {names}</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>%n sites</source>
            <translation>
                <numerusform>%n recinte</numerusform>
                <numerusform>%n recintes</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Link</source>
            <translation>E&amp;nllaç</translation>
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
            <translation>&amp;Serveix aquest recinte…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Speed</source>
            <translation>&amp;Velocitat</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Every robot is sent the map of {site} ({folder}), every desk shows it, and it is served until another one is chosen, also by a gateway that is started anew.</source>
            <translation>Cada robot rep el mapa de {site} ({folder}), cada consola el mostra, i se serveix fins que se'n triï un altre, també si la passarel·la es torna a engegar.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Folder</source>
            <translation>Carpeta</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>From the &amp;beginning again at its end</source>
            <translation>Torna a &amp;començar quan acaba</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No link plays a recording at this gateway.</source>
            <translation>Cap enllaç d'aquesta passarel·la no reprodueix un enregistrament.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot is lost or offline.</source>
            <translation>Cap robot no és perdut ni fora de línia.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot is stopped: commands and queues go on in the same metres, whatever roads and keepouts the new site has there. Stop robots first where that matters.</source>
            <translation>Cap robot no s'atura: les ordres i les cues continuen en els mateixos metres, siguin quines siguin les vies i zones prohibides que el recinte nou hi té. Atureu abans els robots on això importi.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot was removed: {why}</source>
            <translation>No s'ha eliminat cap robot: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>None is stopped by that. One that comes back is told to abort what it still does, and is a new robot.</source>
            <translation>Això no n'atura cap. Al que torni se li diu que avorti el que encara fa, i és un robot nou.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Others cannot be chosen here.</source>
            <translation>Els altres no es poden triar aquí.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Pl&amp;ace</source>
            <translation>&amp;Lloc</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recording of {link}</source>
            <translation>Enregistrament de {link}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings on the map</source>
            <translation>Enregistraments al mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings that links play on the map: pause, speed, place</source>
            <translation>Enregistraments que els enllaços reprodueixen al mapa: pausa, velocitat, lloc</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings…</source>
            <translation>Enregistraments…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove</source>
            <translation>Treu</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove robots that are gone?</source>
            <translation>Voleu eliminar els robots que ja no hi són?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove robots…</source>
            <translation>Elimina robots…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove {names}</source>
            <translation>Elimina {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Seconds after the beginning</source>
            <translation>Segons des del començament</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve this site</source>
            <translation>Serveix aquest recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve {site}</source>
            <translation>Servir {site}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve {site}?</source>
            <translation>Servir {site}?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Site</source>
            <translation>Recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Sites</source>
            <translation>Recintes</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Site…</source>
            <translation>Recinte…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>State</source>
            <translation>Estat</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Take robots that are lost or offline off every desk; takes a supervisor</source>
            <translation>Treu de totes les consoles els robots perduts o fora de línia; cal un supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>The desk is not connected to a gateway. Press Connect first.</source>
            <translation>La consola no està connectada a cap passarel·la. Premeu abans Connecta.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>They go from every desk. What is in their queues is removed, what they were told and have not done has failed; what they did stays stored.</source>
            <translation>Desapareixen de totes les consoles. El que hi ha a les seves cues s'elimina, les ordres que no han fet fallen; el que han fet continua desat.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Version</source>
            <translation>Versió</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Which of the published sites the gateway serves; takes a supervisor</source>
            <translation>Quin dels recintes publicats serveix la passarel·la; cal un supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Which site is served</source>
            <translation>Quin recinte se serveix</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Why, for the log</source>
            <translation>Per què, per al registre</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>all %n that are lost or offline</source>
            <translation>
                <numerusform>l'únic perdut o fora de línia (%n)</numerusform>
                <numerusform>els %n perduts o fora de línia</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>can be chosen</source>
            <translation>es pot triar</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>served now</source>
            <translation>se serveix ara</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>the %n selected ones</source>
            <translation>
                <numerusform>el seleccionat (%n)</numerusform>
                <numerusform>els %n seleccionats</numerusform>
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
            <translation>Ara se serveix {site}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>Asking the gateway …</source>
            <translation>S'està preguntant a la passarel·la …</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>This gateway says nothing of roles: it is older than accounts. Update it.</source>
            <translation>Aquesta passarel·la no diu res de rols: és anterior als comptes. Actualitzeu-la.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>This takes a supervisor, and {operator} is {role} here. If that was changed meanwhile, disconnect and connect again.</source>
            <translation>Per a això cal un supervisor, i aquí el rol de {operator} és {role}. Si mentrestant s'ha canviat, desconnecteu-vos i torneu-vos a connectar.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>{words}: the gateway's answer cannot be read ({kind}). Update the gateway or the plugin, whichever is older.</source>
            <translation>{words}: la resposta de la passarel·la no es pot llegir ({kind}). Actualitzeu la passarel·la o el connector, el que sigui més antic.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>&amp;Copy</source>
            <translation>&amp;Copia</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>A phone whose camera reads this code opens the field page, signed in with the token:</source>
            <translation>Un telèfon que llegeix aquest codi amb la càmera obre la pàgina de camp amb la sessió iniciada amb el testimoni:</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Code for a phone</source>
            <translation>Codi per a un telèfon</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Copied. It stays in the clipboard until something else is copied.</source>
            <translation>Copiat. Es queda al porta-retalls fins que es copiï una altra cosa.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>For a phone: connect this desk by the address that phones reach the gateway by, not by {host}, and a new token has a code here that opens the field page.</source>
            <translation>Per a un telèfon: connecteu aquesta consola per l'adreça amb què els telèfons arriben a la passarel·la, no per {host}, i un testimoni nou tindrà aquí un codi que obre la pàgina de camp.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>The Python package segno is missing, which draws the code for phones. Install the plugin from its release zip, which contains it.</source>
            <translation>Falta el paquet de Python segno, que dibuixa el codi per als telèfons. Instal·leu el connector des del zip de la versió publicada, que el conté.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>This desk was connected with what the token takes the place of, and is cut off. Enter the token in the Fleet panel under Access, then press Connect.</source>
            <translation>Aquesta consola estava connectada amb allò que el testimoni reemplaça, i queda desconnectada. Introduïu el testimoni al tauler de la flota, a Accés, i premeu Connecta.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Token of {operator}</source>
            <translation>Testimoni de {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>holds</source>
            <translation>vàlid</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>{operator}, {role}: the token {until}. It is shown now and never again, and kept nowhere: hand it over on a way that others do not read. If it gets lost, make a new one.</source>
            <translation>{operator}, {role}: testimoni {until}. Es mostra ara i mai més, i no es desa enlloc: lliureu-lo per una via que altres no llegeixin. Si es perd, feu-ne un de nou.</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Across the base of a cone; the cones touch the track's limits</source>
            <translation>Amplada de la base d'un con; els cons toquen els límits de la pista</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Braking lane</source>
            <translation>Carril de frenada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the corridor</source>
            <translation>Amplada lliure del corredor</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the gates</source>
            <translation>Amplada lliure de les portes</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the lane</source>
            <translation>Amplada lliure del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the track</source>
            <translation>Amplada lliure de la pista</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the ways in and out</source>
            <translation>Amplada lliure dels camins d'entrada i sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones inside each inner circle</source>
            <translation>Cons dins de cada cercle interior</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones on each side of each lane</source>
            <translation>Cons a cada costat de cada carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones outside each outer circle</source>
            <translation>Cons fora de cada cercle exterior</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones that close the end of the lane</source>
            <translation>Cons que tanquen el final del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones that close the way out</source>
            <translation>Cons que tanquen el camí de sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones to go round</source>
            <translation>Cons que cal envoltar</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Constant-radius circle</source>
            <translation>Cercle de radi constant</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Corridor</source>
            <translation>Corredor</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Diameter of the inner circles</source>
            <translation>Diàmetre dels cercles interiors</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Diameter of the outer circles</source>
            <translation>Diàmetre dels cercles exteriors</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Double lane change</source>
            <translation>Doble canvi de carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student Rules, D 4.1</source>
            <translation>Reglament de Formula Student, D 4.1</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student Rules, D 5.1</source>
            <translation>Reglament de Formula Student, D 5.1</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student acceleration</source>
            <translation>Acceleració de Formula Student</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student skid pad</source>
            <translation>Skid pad de Formula Student</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From a gate to the nearest cone</source>
            <translation>D'una porta al con més proper</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From a line to the big cones before and behind it</source>
            <translation>D'una línia als cons grans d'abans i després</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From centre to centre of the circles</source>
            <translation>De centre a centre dels cercles</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone</source>
            <translation>De con a con</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the lane</source>
            <translation>De con a con al llarg del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the middle of the lane</source>
            <translation>De con a con al llarg del mig del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the track</source>
            <translation>De con a con al llarg de la pista</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the ways in and out</source>
            <translation>De con a con al llarg dels camins d'entrada i sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From pair to pair</source>
            <translation>De parella a parella</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the left limit of the entry lane to the right one of the side lane</source>
            <translation>Del límit esquerre del carril d'entrada al dret del carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the meeting point to the first cones of the ways in and out</source>
            <translation>Del punt de trobada als primers cons dels camins d'entrada i sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the middle of the path to these cones</source>
            <translation>Del mig del camí a aquests cons</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the right limit of the entry lane to that of the side lane</source>
            <translation>Del límit dret del carril d'entrada al del carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the starting line to the finish line</source>
            <translation>De la línia de sortida a la d'arribada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the timing line to the big cones before and behind it</source>
            <translation>De la línia de cronometratge als cons grans d'abans i després</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>ISO 4138:2021, method 1</source>
            <translation>ISO 4138:2021, mètode 1</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Lane before braking begins</source>
            <translation>Carril abans de començar a frenar</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Lane to stop in behind the finish line</source>
            <translation>Carril d'aturada després de la línia d'arribada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Least width of the exit lane</source>
            <translation>Amplada mínima del carril de sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the corridor</source>
            <translation>Llargada del corredor</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the way in that has cones</source>
            <translation>Llargada amb cons del camí d'entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the way out that has cones</source>
            <translation>Llargada amb cons del camí de sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Obstacle avoidance</source>
            <translation>Evitació d'obstacles</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Part of each outer circle that has cones</source>
            <translation>Part de cada cercle exterior que té cons</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Radius of the middle of the lane</source>
            <translation>Radi del mig del carril</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 1: entry lane</source>
            <translation>Secció 1: carril d'entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 2: way to the side lane</source>
            <translation>Secció 2: camí cap al carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 3: side lane</source>
            <translation>Secció 3: carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 4: way back</source>
            <translation>Secció 4: camí de tornada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 5: exit lane</source>
            <translation>Secció 5: carril de sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Sections 5 and 6: exit lane</source>
            <translation>Seccions 5 i 6: carril de sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Slalom</source>
            <translation>Eslàlom</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Speed at which braking begins</source>
            <translation>Velocitat a què comença la frenada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>To which side it goes first</source>
            <translation>Cap a quin costat va primer</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the entry lane</source>
            <translation>Amplades de vehicle en l'amplada del carril d'entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the exit lane</source>
            <translation>Amplades de vehicle en l'amplada del carril de sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the side lane</source>
            <translation>Amplades de vehicle en l'amplada del carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to each of these widths</source>
            <translation>El que s'afegeix a cadascuna d'aquestes amplades</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the entry lane</source>
            <translation>El que s'afegeix a l'amplada del carril d'entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the exit lane</source>
            <translation>El que s'afegeix a l'amplada del carril de sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the side lane</source>
            <translation>El que s'afegeix a l'amplada del carril lateral</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What of the exit lane is in line with the entry lane</source>
            <translation>Què del carril de sortida està alineat amb el d'entrada</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Which way it is driven</source>
            <translation>En quin sentit es recorre</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Width of the vehicle without mirrors</source>
            <translation>Amplada del vehicle sense miralls</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>collect them</source>
            <translation>recollir-los</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>done as early as possible</source>
            <translation>acabar al més aviat possible</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>drive back</source>
            <translation>tornen</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>drive to a store</source>
            <translation>van a un magatzem</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>fewest metres</source>
            <translation>menys metres</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give a number</source>
            <translation>doneu un nombre</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give a whole number</source>
            <translation>doneu un nombre enter</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give one of {choices}</source>
            <translation>doneu-ne un de {choices}</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give {least:g} or more</source>
            <translation>doneu {least:g} o més</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>left</source>
            <translation>esquerra</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>left limit</source>
            <translation>límit esquerre</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>length after UN R13-H; test after ISO 21994</source>
            <translation>llargada segons UN R13-H; assaig segons ISO 21994</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>middle</source>
            <translation>centre</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>no standard: 18 m as European testers drive it</source>
            <translation>cap norma: 18 m, com la condueixen els provadors europeus</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>no standard: colours, width and spacing of Formula Student</source>
            <translation>cap norma: colors, amplada i separació de Formula Student</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>place them</source>
            <translation>col·locar-los</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>quick preview</source>
            <translation>vista prèvia ràpida</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>right</source>
            <translation>dreta</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>right limit</source>
            <translation>límit dret</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>solved</source>
            <translation>resolt</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>solved: nothing better than the preview was found</source>
            <translation>resolt: no s'ha trobat res millor que la vista prèvia</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>stay where they are</source>
            <translation>queden on són</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>the best that is installed</source>
            <translation>el millor dels instal·lats</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>the preview: quick, not the best</source>
            <translation>la previsualització: ràpida, no la millor</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>to the left</source>
            <translation>a l'esquerra</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>to the right</source>
            <translation>a la dreta</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is where a cone stands: {robot} put it down at {cone_x:.2f}, {cone_y:.2f}.</source>
            <translation>({x:.2f}, {y:.2f}) m és on hi ha un con: {robot} el va posar a {cone_x:.2f}, {cone_y:.2f}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is where {robot} stands.</source>
            <translation>({x:.2f}, {y:.2f}) m és on està aturat {robot}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is {away:.2f} m from {what} of {robot} at {other_x:.2f}, {other_y:.2f}: keep {clear_m:g} m between targets.</source>
            <translation>({x:.2f}, {y:.2f}) m és a {away:.2f} m de {what} de {robot} a {other_x:.2f}, {other_y:.2f}: deixeu {clear_m:g} m entre objectius.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>No layer of the project says where obstacles and keepouts are, so nobody has looked. Open the site's project, or give layers their roles.</source>
            <translation>Cap capa del projecte diu on hi ha obstacles i zones prohibides, així que ningú no ho ha mirat. Obriu el projecte del recinte o doneu papers a les capes.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} cannot be read, so what is in it was not looked at. Repair its source, or take its role away.</source>
            <translation>La capa {layer} no es pot llegir, així que no s'ha mirat què hi ha. Repareu-ne l'origen o traieu-li el paper.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} has no CRS, so nobody knows where on the site it lies. Set it (Layer &gt; Set CRS of Layer), or take its role away.</source>
            <translation>La capa {layer} no té SRC, així que ningú no sap en quin lloc del recinte és. Definiu-lo (Capa &gt; Defineix el SRC de la capa) o traieu-li el paper.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} has not answered for {seconds:g} s, so what is in it was not looked at. Bring its server or drive back and try again, or take the role of the layer away.</source>
            <translation>La capa {layer} no respon des de fa {seconds:g} s, així que no s'ha mirat què hi ha. Restabliu-ne el servidor o la unitat i torneu-ho a provar, o traieu el paper a la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The project has no CRS, so the map is taken to be in the site's, {crs}; a layer in another CRS lies at a wrong place on it. Choose the project's CRS at the bottom right in QGIS.</source>
            <translation>El projecte no té SRC, de manera que es considera que el mapa és en el del recinte, {crs}; una capa en un altre SRC hi surt en un lloc equivocat. Trieu el SRC del projecte a baix a la dreta del QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>a task</source>
            <translation>una tasca</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>the end of the route</source>
            <translation>el final de la ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>the target</source>
            <translation>l'objectiu</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot be sent to targets.</source>
            <translation>{robot} no es pot enviar a objectius.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot be told where it starts.</source>
            <translation>A {robot} no se li pot dir on comença.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot follow routes.</source>
            <translation>{robot} no pot seguir rutes.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is at work for {operator} ({task}): sending this takes its place.</source>
            <translation>{robot} treballa per a {operator} ({task}): si s'envia, ho substitueix.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is only seen: it takes no commands.</source>
            <translation>{robot} només es veu: no accepta ordres.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is {state}: it is told this when it is heard again, if that is soon enough.</source>
            <translation>{robot}: {state}; rebrà això quan se'n torni a saber, si és prou aviat.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} places no cones.</source>
            <translation>{robot} no col·loca cons.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} places no cones: it only drives there.</source>
            <translation>{robot} no col·loca cons: només hi va.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{where} m is outside the site {name}, which reaches from ({x_min:g}, {y_min:g}) to ({x_max:g}, {y_max:g}) m. Click inside it.</source>
            <translation>{where} m és fora del recinte {name}, que va de ({x_min:g}, {y_min:g}) a ({x_max:g}, {y_max:g}) m. Feu clic a dins.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>latitude, longitude</source>
            <translation>latitud, longitud</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>latitude, longitude, as in 48.2083, 16.3725</source>
            <translation>latitud, longitud, com ara 48.2083, 16.3725</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>x, y</source>
            <translation>x, y</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>x, y, as in 488070.50, 5190055.20</source>
            <translation>x, y, com ara 488070.50, 5190055.20</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{shown!r} is no place: write {right}.</source>
            <translation>{shown!r} no és cap lloc: escriviu {right}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r} is not on the site {name}; with its two numbers swapped it is. Write {order}: {first:.10g}, {second:.10g}.</source>
            <translation>{text!r} no és al recinte {name}; amb els dos nombres intercanviats, sí. Escriviu {order}: {first:.10g}, {second:.10g}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r} is {away:.0f} km outside the site {name}. Write {order}, and check the numbers and the CRS that they are in ({crs}).</source>
            <translation>{text!r} és {away:.0f} km fora del recinte {name}. Escriviu {order}, i comproveu els nombres i el seu SRC ({crs}).</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r}: latitude {lat:g} and longitude {lon:g} are not on the earth; write latitude first, or choose the CRS that the numbers are in.</source>
            <translation>{text!r}: la latitud {lat:g} i la longitud {lon:g} no són a la Terra; escriviu abans la latitud, o trieu el SRC en què són els nombres.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>Abort of {robot}</source>
            <translation>Avortar {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>No robot is selected, so none was aborted. Select it in the table or on the map.</source>
            <translation>No hi ha cap robot seleccionat, així que no se n'ha avortat cap. Seleccioneu-lo a la taula o al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>Pause of {robot}</source>
            <translation>Pausa de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>The operator's name is empty. Write who you are: it stands in every log.</source>
            <translation>El nom de l'operador és buit. Escriviu qui sou: és a tots els registres.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>This gateway serves another site than the rest of the fleet: {reason}.</source>
            <translation>Aquesta passarel·la serveix un altre recinte que la resta de la flota: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>{words} was not sent: another site is served now. Draw it anew.</source>
            <translation>{words}: no s'ha enviat, perquè ara se serveix un altre recinte. Torneu-ho a dibuixar.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>{words} was not sent: robot {robot} was removed.</source>
            <translation>{words}: no s'ha enviat, perquè s'ha eliminat el robot {robot}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>({x:.2f}, {y:.2f}) m</source>
            <translation>({x:.2f}, {y:.2f}) m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The layer {layer} cannot be placed on the site ({error}), so obstacles in it are not seen. Correct its CRS, or take its role away.</source>
            <translation>La capa {layer} no es pot situar al recinte ({error}), així que els seus obstacles no es veuen. Corregiu-ne el SRC, o traieu-li el paper.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The route</source>
            <translation>La ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The way to {to}</source>
            <translation>El camí fins a {to}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The way to {to} leaves the road surface.</source>
            <translation>El camí fins a {to} surt de la superfície de via.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>is on</source>
            <translation>és sobre</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>is {away:.2f} m from</source>
            <translation>és a {away:.2f} m de</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{layer} (feature {id})</source>
            <translation>{layer} (entitat {id})</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{leave} of {legs} legs leave the road surface.</source>
            <translation>{leave} de {legs} trams surten de la superfície de via.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{off} of {points} points are not on a road surface.</source>
            <translation>{off} de {points} punts són fora de les superfícies de via.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{place} is not on a road surface.</source>
            <translation>{place} és fora de les superfícies de via.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{spot} enters the keepout {name}. Choose a place or way outside it.</source>
            <translation>{spot} entra a la zona prohibida {name}. Trieu un lloc o recorregut fora.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{spot} {where} {name}. Choose a place or way beside it.</source>
            <translation>{spot} {where} {name}. Trieu un lloc o recorregut al costat.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link} is down: {reason}.</source>
            <translation>L'enllaç {link} està caigut: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link} is down: {reason}. Nothing reaches {robots}.</source>
            <translation>L'enllaç {link} està caigut: {reason}. Res no arriba a {robots}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link}: {reason}.</source>
            <translation>Enllaç {link}: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>The database account of robot {robot} is locked until {time}: its program kept all others waiting. Nothing but a stop reaches it: Abort unlocks the account. Have the program mended.</source>
            <translation>El compte de base de dades del robot {robot} està bloquejat fins a les {time}: el seu programa feia esperar tots els altres. Només hi arriba una parada: Avorta desbloqueja el compte. Feu arreglar el programa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>The program of robot {robot} keeps all others waiting at the database, and its account cannot be locked. Have an administrator run: robot-bridge database upgrade</source>
            <translation>El programa del robot {robot} fa esperar tots els altres a la base de dades, i el seu compte no es pot bloquejar. Que un administrador executi: robot-bridge database upgrade</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>{names} and {count} more</source>
            <translation>{names} i {count} més</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/control/pending_command.py" />
            <source>%n cones for {robot}</source>
            <translation>
                <numerusform>%n con per a {robot}</numerusform>
                <numerusform>%n cons per a {robot}</numerusform>
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
            <translation>; per les vies {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>; straight</source>
            <translation>; recte</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>; the way there is being found</source>
            <translation>; s’està buscant el camí fins allà</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>A part of this route follows the roads, and the way back may be another: it is not turned round. Draw it from the other end with Route on roads.</source>
            <translation>Una part d'aquesta ruta segueix les vies, i la tornada pot ser una altra: no es gira. Dibuixeu-la des de l'altre extrem amb Ruta per vies.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>A start position is no task: Send tells the robot at once.</source>
            <translation>Una posició inicial no és cap tasca: Envia ho diu al robot de seguida.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>And {more} more.</source>
            <translation>I {more} més.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Cone for {robot} at {place}</source>
            <translation>Con per a {robot} a {place}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Route for {robot}: {points} points, {length:.1f} m{along_roads}</source>
            <translation>Ruta per a {robot}: {points} punts, {length:.1f} m{along_roads}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Start position of {robot} at {place}{turned}</source>
            <translation>Posició inicial de {robot} a {place}{turned}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>This part of the route follows the roads and is not changed by hand. Take it back with Backspace, or draw this part with Draw route.</source>
            <translation>Aquesta part de la ruta segueix les vies i no es canvia a mà. Traieu-la amb Retrocés, o dibuixeu aquesta part amb Dibuixa ruta.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>a route needs at least two points: click the next one</source>
            <translation>una ruta necessita almenys dos punts: feu clic al següent</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>it has not been checked to its end</source>
            <translation>encara no s'ha acabat de comprovar</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>the way there is not known yet</source>
            <translation>encara no se sap el camí fins allà</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>{x:.2f}, {y:.2f} m</source>
            <translation>{x:.2f}, {y:.2f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>ABORT ALL</source>
            <translation>AVORTA-HO TOT</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Clear emergency stop</source>
            <translation>Aixeca la parada d'emergència</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Closing the road at {x:.1f}, {y:.1f} m</source>
            <translation>Tancament de la via a {x:.1f}, {y:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>EMERGENCY STOP</source>
            <translation>PARADA D'EMERGÈNCIA</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>EMERGENCY STOP is NOT sent yet: the link is down. It is sent as soon as that is back; use the robots' own emergency stops now.</source>
            <translation>La PARADA D'EMERGÈNCIA encara NO s'ha enviat: l'enllaç està tallat. S'envia quan torni; feu servir ara les parades d'emergència dels mateixos robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Opening the road</source>
            <translation>Obertura de la via</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>The Abort is NOT sent yet: the link is down. It is sent if that is back within {seconds:g} s; use the robots' own emergency stops now.</source>
            <translation>L'avortament encara NO s'ha enviat: l'enllaç està tallat. S'envia si torna abans de {seconds:g} s; feu servir ara les parades d'emergència dels mateixos robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>the desk is not connected to a gateway. Connect first; to stop a robot now use the robot's own emergency stop.</source>
            <translation>la consola no està connectada a cap passarel·la. Connecteu abans; per aturar ara un robot feu servir la seva parada d'emergència.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>this window, or the computer, stood still for {seconds:.0f} s, and what was clicked meanwhile may be old. Look at the robots, then ask again.</source>
            <translation>aquesta finestra, o l'ordinador, ha estat aturada {seconds:.0f} s, i allò que s'ha clicat mentrestant pot ser antic. Mireu els robots i torneu-ho a demanar.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{draft} was not sent: {fault}</source>
            <translation>{draft}: no s'ha enviat: {fault}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{draft} were not sent: several targets are driven to one after the other. Press Add to queue.</source>
            <translation>{draft}: no s'ha enviat: a diversos objectius s'hi va un darrere l'altre. Premeu Afegeix a la cua.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{robot} gives way to {other}</source>
            <translation>{robot} cedeix el pas a {other}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words} was NOT sent: {error}</source>
            <translation>{words}: NO s'ha enviat: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: done</source>
            <translation>{words}: fet</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: sent to %n robots</source>
            <translation>
                <numerusform>{words}: enviat a %n robot</numerusform>
                <numerusform>{words}: enviat a %n robots</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated if the link is back within {limit:g} s, unless robots are asked to stop meanwhile; it is never done twice.</source>
            <translation>{words}: la passarel·la no ha respost en {seconds:g} s, de manera que potser no ha arribat. Es repeteix si l'enllaç torna en {limit:g} s, tret que mentrestant es demani aturar robots; mai no es fa dues vegades.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated if the link is back within {limit:g} s; it is never done twice.</source>
            <translation>{words}: la passarel·la no ha respost en {seconds:g} s, de manera que potser no ha arribat. Es repeteix si l'enllaç torna en {limit:g} s; mai no es fa dues vegades.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated when the link is back; it is never done twice.</source>
            <translation>{words}: la passarel·la no ha respost des de fa {seconds:g} s, així que potser no ha arribat. Es repeteix quan torna l'enllaç; mai no es fa dues vegades.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>The gateway has not answered for {seconds:g} s which way leads to where you clicked, so the route does not go there. Click there again.</source>
            <translation>La passarel·la no ha respost des de fa {seconds:g} s quin camí porta on heu fet clic, així que la ruta no hi va. Torneu-hi a fer clic.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>corners tighter than the robot turns: {tight}</source>
            <translation>cantonades més tancades que el gir del robot: {tight}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>off the roads of other robots</source>
            <translation>fora de les vies d'altres robots</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>only on {surfaces}</source>
            <translation>només per {surfaces}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>roads at least {metres:g} m wide</source>
            <translation>vies d'almenys {metres:g} m d'amplada</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>surface not known</source>
            <translation>superfície desconeguda</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>the fastest way</source>
            <translation>el camí més ràpid</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>the gateway's answer holds no way; it may be older than this plugin</source>
            <translation>la resposta de la passarel·la no porta cap recorregut; pot ser més antiga que aquest connector</translation>
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
            <translation>No hi ha res a enviar. Seleccioneu un robot, i poseu un objectiu de con o dibuixeu una ruta al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent, since only now this is known: {warnings} Ask for it again to send it all the same.</source>
            <translation>{in_words}: no s'ha enviat, perquè fins ara no se sabia això: {warnings} Torneu-ho a demanar per enviar-ho igualment.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: robots were told to stop before it had been checked.</source>
            <translation>{in_words}: no s'ha enviat, perquè s'ha ordenat aturar els robots abans d'acabar la comprovació.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: the draft was changed before it had been checked. Send it anew.</source>
            <translation>{in_words}: no s'ha enviat, perquè l'esborrany ha canviat abans d'acabar la comprovació. Torneu-lo a enviar.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: {error}</source>
            <translation>{in_words} no s'ha enviat: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: {robot} has moved since its way was found. It is found again from where the robot is now; send it when it is drawn.</source>
            <translation>{in_words} no s’ha enviat: {robot} s’ha mogut des que es va trobar el seu camí. Es torna a buscar des d’on és ara el robot; envieu-lo quan estigui dibuixat.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>It is not known where {robot} is, so nobody has looked at the way that it drives.</source>
            <translation>No se sap on és {robot}, de manera que ningú no ha comprovat el camí que fa.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>No way along the roads leads there: {why}.</source>
            <translation>Cap camí per les vies hi porta: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>The gateway does not answer which way leads there. Set the target again when the link is there.</source>
            <translation>La passarel·la no respon quin camí hi porta. Torneu a posar l’objectiu quan hi hagi connexió.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>{robot} has not declared that it asks for its path or takes cones with one: sent now it drives straight. Add to queue, with a route around what is in its way, where that is not wanted.</source>
            <translation>{robot} no ha declarat que demani el seu camí ni que accepti cons amb un camí: enviat ara, va recte. On això no convingui, afegiu-lo a la cua amb una ruta que eviti el que hi ha al mig.</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function distance_to_robot&lt;/h3&gt; &lt;p&gt;Returns how far a robot is from a feature or a geometry, in metres of the site.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;distance_to_robot(robot, [geometry], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;geometry&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional; without it, that of the feature that is looked at&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the CRS of the geometry, such as 'EPSG:4326'; without it, that of the layer whose feature is looked at, else that of the project&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1')&lt;/code&gt; &amp;rarr; 12.3&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1', make_point(16.8438, 46.8804), 'EPSG:4326')&lt;/code&gt; &amp;rarr; 104.6&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1') &amp;lt; 5&lt;/code&gt; &amp;rarr; true of features near the robot&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;The distance is measured in the plane of the site's CRS; in a polygon it is 0. NULL stands for a robot whose place is not known, and while this QGIS is connected to no gateway. Places are at most half a second old; a layer shows them when it is drawn.&lt;/p&gt;</source>
            <translation>&lt;h3&gt;funció distance_to_robot&lt;/h3&gt; &lt;p&gt;Retorna a quina distància és un robot d'una entitat o d'una geometria, en metres del recinte.&lt;/p&gt; &lt;h4&gt;Sintaxi&lt;/h4&gt; &lt;p&gt;&lt;code&gt;distance_to_robot(robot, [geometry], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;el seu nom, com al tauler Flota&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;geometry&lt;/i&gt;&lt;/td&gt;&lt;td&gt;opcional; sense, la de l'entitat que es mira&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;opcional, el SRC de la geometria, com ara 'EPSG:4326'; sense, el de la capa l'entitat de la qual es mira, o si no el del projecte&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Exemples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1')&lt;/code&gt; &amp;rarr; 12.3&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1', make_point(16.8438, 46.8804), 'EPSG:4326')&lt;/code&gt; &amp;rarr; 104.6&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1') &amp;lt; 5&lt;/code&gt; &amp;rarr; cert per a les entitats a prop del robot&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;La distància es mesura al pla del SRC del recinte; dins d'un polígon és 0. NULL si no se sap on és el robot, i mentre aquest QGIS no està connectat a cap passarel·la. Els llocs tenen com a màxim mig segon; una capa els mostra quan es dibuixa.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function road_surface&lt;/h3&gt; &lt;p&gt;Returns the class of the road surface at a place, such as 'asphalt', or NULL where there is none.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;road_surface(x, y, [layer], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;x, y&lt;/i&gt;&lt;/td&gt;&lt;td&gt;the place; x is the easting or the longitude, whatever the CRS&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;layer&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the name or id of a layer of areas; without it, all layers of the project with the role road surface&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the CRS of the place, such as 'EPSG:4326'; without it, that of the layer whose feature is looked at, else that of the project&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y)&lt;/code&gt; &amp;rarr; 'asphalt'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface(16.8438, 46.8804, crs:='EPSG:4326')&lt;/code&gt; &amp;rarr; 'slippery'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y, 'Road surfaces') IS NULL&lt;/code&gt; &amp;rarr; true off the road&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;A place on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a generated one, then the smaller before the larger.&lt;/p&gt;</source>
            <translation>&lt;h3&gt;funció road_surface&lt;/h3&gt; &lt;p&gt;Retorna la classe de la superfície de via en un lloc, com ara 'asphalt', o NULL on no n'hi ha.&lt;/p&gt; &lt;h4&gt;Sintaxi&lt;/h4&gt; &lt;p&gt;&lt;code&gt;road_surface(x, y, [layer], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;x, y&lt;/i&gt;&lt;/td&gt;&lt;td&gt;el lloc; x és l'est o la longitud, sigui quin sigui el SRC&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;layer&lt;/i&gt;&lt;/td&gt;&lt;td&gt;opcional, el nom o l'identificador d'una capa d'àrees; sense, totes les capes del projecte amb el paper de superfície de via&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;opcional, el SRC del lloc, com ara 'EPSG:4326'; sense, el de la capa l'entitat de la qual es mira, o si no el del projecte&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Exemples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y)&lt;/code&gt; &amp;rarr; 'asphalt'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface(16.8438, 46.8804, crs:='EPSG:4326')&lt;/code&gt; &amp;rarr; 'slippery'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y, 'Road surfaces') IS NULL&lt;/code&gt; &amp;rarr; cert fora de la via&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;Un lloc a la vora és a la superfície. On les superfícies se superposen compta abans una de dibuixada que una de generada, i després la més petita abans que la més gran.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_age&lt;/h3&gt; &lt;p&gt;Returns the seconds since a robot's last message, by this computer's clock.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_age(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_age('r1')&lt;/code&gt; &amp;rarr; 0.4&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_age('r1') &amp;gt; 10&lt;/code&gt; &amp;rarr; true once it has been silent for more than 10 seconds&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;funció robot_age&lt;/h3&gt; &lt;p&gt;Retorna els segons des de l'últim missatge d'un robot, segons el rellotge d'aquest ordinador.&lt;/p&gt; &lt;h4&gt;Sintaxi&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_age(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;el seu nom, com al tauler Flota&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Exemples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_age('r1')&lt;/code&gt; &amp;rarr; 0.4&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_age('r1') &amp;gt; 10&lt;/code&gt; &amp;rarr; cert quan fa més de 10 segons que calla&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_battery&lt;/h3&gt; &lt;p&gt;Returns how full a robot's battery is, 0 to 1.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_battery(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_battery('r1')&lt;/code&gt; &amp;rarr; 0.82&lt;/li&gt; &lt;li&gt;&lt;code&gt;round(100 * robot_battery('r1')) || ' %'&lt;/code&gt; &amp;rarr; '82 %'&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;funció robot_battery&lt;/h3&gt; &lt;p&gt;Retorna com de plena és la bateria d'un robot, de 0 a 1.&lt;/p&gt; &lt;h4&gt;Sintaxi&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_battery(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;el seu nom, com al tauler Flota&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Exemples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_battery('r1')&lt;/code&gt; &amp;rarr; 0.82&lt;/li&gt; &lt;li&gt;&lt;code&gt;round(100 * robot_battery('r1')) || ' %'&lt;/code&gt; &amp;rarr; '82 %'&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_state&lt;/h3&gt; &lt;p&gt;Returns how far what is known of a robot can be trusted: 'fresh', 'stale', 'lost' or 'offline'.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_state(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_state('r1')&lt;/code&gt; &amp;rarr; 'fresh'&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_state("robot") IN ('stale', 'lost')&lt;/code&gt; &amp;rarr; true of robots that are silent&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;funció robot_state&lt;/h3&gt; &lt;p&gt;Retorna fins a quin punt es pot confiar en el que se sap d'un robot: 'fresh' (actual), 'stale' (desactualitzat), 'lost' (perdut) o 'offline' (fora de línia).&lt;/p&gt; &lt;h4&gt;Sintaxi&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_state(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;el seu nom, com al tauler Flota&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Exemples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_state('r1')&lt;/code&gt; &amp;rarr; 'fresh'&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_state("robot") IN ('stale', 'lost')&lt;/code&gt; &amp;rarr; cert per als robots que callen&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;NULL stands for a robot that the gateway has not told of, and while this QGIS is connected to none. What is not known of a robot is NULL as well. Values are at most half a second old; a layer shows them when it is drawn.&lt;/p&gt;</source>
            <translation>&lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;NULL si la passarel·la no ha parlat del robot, i mentre aquest QGIS no està connectat a cap. El que no se sap d'un robot també és NULL. Els valors tenen com a màxim mig segon; una capa els mostra quan es dibuixa.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;p&gt;Of more than 5 000 robots QGIS is told of those on the map. Another one is asked for when an expression names it, and for a minute from then on, up to 200 of them: about a second later it has its value, NULL until then.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Amb més de 5 000 robots, el QGIS rep dades dels que són al mapa. Un altre es demana quan una expressió l'anomena, i durant un minut des de llavors, fins a 200: al cap d'un segon aproximadament té el seu valor; fins aleshores, NULL.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>Fleet</source>
            <translation>Flota</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>crs {given!r} is no CRS that QGIS knows; write a code such as 'EPSG:32633'</source>
            <translation>crs {given!r} no és cap SRC que el QGIS conegui; escriviu un codi com ara 'EPSG:32633'</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>no layer of the project has the role {role}; set it in Plugins &gt; Fleet Supervisor &gt; Layer roles, or name a layer as the third argument</source>
            <translation>cap capa del projecte no té el paper {role}; poseu-lo a Connectors &gt; Fleet Supervisor &gt; Papers de les capes, o anomeneu una capa com a tercer argument</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>no vector layer of the project has the name or id {layer!r}</source>
            <translation>cap capa vectorial del projecte no té el nom o l'identificador {layer!r}</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: the geometry has no place in {crs}</source>
            <translation>{function}: la geometria no té lloc a {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: x is {x!r} and y is {y!r}; give two numbers</source>
            <translation>{function}: x és {x!r} i y és {y!r}; doneu dos nombres</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: {geometry!r} is no geometry; give one, or a feature that has one</source>
            <translation>{function}: {geometry!r} no és cap geometria; doneu-ne una, o una entitat que en tingui</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>abort</source>
            <translation>avortament</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>cone at {x}, {y}</source>
            <translation>con a {x}, {y}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>done</source>
            <translation>fet</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>route of {number} points</source>
            <translation>ruta de {number} punts</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>target at {x}, {y}</source>
            <translation>objectiu a {x}, {y}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>A stop would wait for the rest of a large request on the slow line to {url}: the link is opened again, and the stop sent first.</source>
            <translation>Una aturada hauria d'esperar la resta d'una petició gran en la línia lenta cap a {url}: la connexió es torna a obrir, i l'aturada s'envia primer.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The CA file {file} has not answered for {seconds:g} s, so there is no link to {url} yet: the drive that it is on may be away. The desk waits for it. If it stays away, press Disconnect and choose a copy of the file on this computer.</source>
            <translation>El fitxer de CA {file} no respon des de fa {seconds:g} s, així que encara no hi ha enllaç amb {url}: potser la unitat on és no està disponible. La consola l'espera. Si no torna, premeu Desconnecta i trieu una còpia del fitxer en aquest ordinador.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The connection stopped on an internal fault ({name}: {error}). Press Connect to try again and report this text.</source>
            <translation>La connexió s'ha aturat per un error intern ({name}: {error}). Premeu Connecta per tornar-ho a provar i comuniqueu aquest text.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The gateway at {url} closed the link. It is tried again.</source>
            <translation>La passarel·la a {url} ha tancat l'enllaç. Es torna a provar.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>This computer slept, or did nothing, for {seconds:.0f} s: what waits for it is old. The link is opened anew.</source>
            <translation>Aquest ordinador ha dormit, o no ha fet res, durant {seconds:.0f} s: el que l'espera és antic. La connexió es torna a obrir.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>What answers at {url} opens a WebSocket but did not answer the desk's greeting within {answer_within:g} s. Check that the URL leads to a Fleet Supervisor gateway.</source>
            <translation>El que respon a {url} obre un WebSocket però no ha contestat la salutació de la consola en {answer_within:g} s. Comproveu que l'URL porta a una passarel·la de Fleet Supervisor.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>at {gateway}; {given} did not answer</source>
            <translation>a {gateway}; {given} no ha respost</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>at {gateway}; {given} refuses this desk</source>
            <translation>a {gateway}; {given} refusa aquesta consola</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>No secure link to {place}: {reason}. If the gateway has no TLS, write ws:// instead of wss://.</source>
            <translation>No hi ha enllaç segur amb {place}: {reason}. Si la passarel·la no té TLS, escriviu ws:// en lloc de wss://.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Nothing listens at {place}. Start the gateway (robot-bridge serve --site ...) or correct the URL.</source>
            <translation>No escolta res a {place}. Arrenqueu la passarel·la (robot-bridge serve --site ...) o corregiu l'URL.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Over {url} everybody on the way could read the token. Write wss:// instead of ws://; a gateway that other computers can reach has TLS.</source>
            <translation>Per {url} tothom pel camí podria llegir el testimoni. Escriviu wss:// en lloc de ws://; una passarel·la accessible des d'altres ordinadors té TLS.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The CA file {file} cannot be used: {reason}. Choose the ca.pem that whoever runs the site gave you.</source>
            <translation>El fitxer de CA {file} no es pot fer servir: {reason}. Trieu el ca.pem que us va donar qui porta el recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} cannot be trusted: {reason}.</source>
            <translation>No es pot confiar en el certificat de {place}: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} has expired. Whoever runs the site renews it with 'robot-bridge tls renew'; if it was renewed, check this computer's clock.</source>
            <translation>El certificat de {place} ha caducat. Qui porta el recinte el renova amb 'robot-bridge tls renew'; si ja s'ha renovat, comproveu el rellotge d'aquest ordinador.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} holds only later: check this computer's clock.</source>
            <translation>El certificat de {place} només val més tard: comproveu el rellotge d'aquest ordinador.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} is for another name: {reason} Use the name that the gateway's certificate was made for, or have one made for this name.</source>
            <translation>El certificat de {place} és per a un altre nom: {reason} Feu servir el nom per al qual es va fer el certificat de la passarel·la, o feu-ne fer un per a aquest nom.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} is from an authority that this desk does not trust. Choose the site's ca.pem as CA file under Access; whoever runs the site has it.</source>
            <translation>El certificat de {place} és d'una autoritat en què aquesta consola no confia. Trieu el ca.pem del recinte com a fitxer de CA a Accés; el té qui porta el recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} closed the link (code {code}{why}). It is tried again by itself.</source>
            <translation>La passarel·la a {place} ha tancat l'enllaç (codi {code}{why}). Es torna a provar sol.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} ended the link{why}. Ask whoever runs the site for a new token and enter it under Access.</source>
            <translation>La passarel·la a {place} ha acabat l'enllaç{why}. Demaneu un testimoni nou a qui porta el recinte i introduïu-lo a Accés.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} ended your session{why}. Connect brings it back.</source>
            <translation>La passarel·la a {place} ha acabat la vostra sessió{why}. Connecta la recupera.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL is empty. {example}</source>
            <translation>L'URL de la passarel·la és buida. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} begins with {scheme}; a gateway is reached over ws:// (or wss:// with TLS). {example}</source>
            <translation>L'URL de la passarel·la {url} comença per {scheme}; s'hi arriba per ws:// (o wss:// amb TLS). {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} cannot be read: {error}. {example}</source>
            <translation>L'URL de la passarel·la {url} no es pot llegir: {error}. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} cannot be used. Write it like {default_url}.</source>
            <translation>L'URL de la passarel·la {url} no es pot fer servir. Escriviu-la com {default_url}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} has port 0, where nothing can listen. {example}</source>
            <translation>L'URL de la passarel·la {url} té el port 0, on res pot escoltar. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} names no host. {example}</source>
            <translation>L'URL de la passarel·la {url} no anomena cap servidor. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The host of {place} is not known to this network. Correct the URL.</source>
            <translation>Aquesta xarxa no coneix el servidor de {place}. Corregiu l'URL.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The link to the gateway at {place} broke off. It is tried again by itself; if it does not come back, check the gateway and the network.</source>
            <translation>L'enllaç amb la passarel·la a {place} s'ha trencat. Es torna a provar sol; si no torna, comproveu la passarel·la i la xarxa.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The token cannot be right: it is one word. Paste it again, whole and alone.</source>
            <translation>El testimoni no pot ser correcte: és una sola paraula. Enganxeu-lo una altra vegada, sencer i sol.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>There is no desk at {url} (HTTP 404). A gateway's desk has the path /desk, as in {default_url}; or another program answers there.</source>
            <translation>No hi ha cap consola a {url} (HTTP 404). La d'una passarel·la té el camí /desk, com a {default_url}; o hi respon un altre programa.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>What answers at {place} does not speak WebSocket. Check host and port, and ws:// or wss://: a gateway prints its URL when it starts.</source>
            <translation>El que respon a {place} no parla WebSocket. Comproveu servidor i port, i ws:// o wss://: una passarel·la escriu la seva URL quan arrenca.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>What answers at {url} sent something that is not the desk's protocol: {text} ({kind}: {error}). Check that the URL leads to a Fleet Supervisor gateway of this version.</source>
            <translation>El que respon a {url} ha enviat una cosa que no és el protocol de la consola: {text} ({kind}: {error}). Comproveu que l'URL porta a una passarel·la de Fleet Supervisor d'aquesta versió.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Write it like {default_url}.</source>
            <translation>Escriviu-la com {default_url}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>it wants a token.</source>
            <translation>vol un testimoni.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>no reason given.</source>
            <translation>sense dir per què.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>no scheme</source>
            <translation>cap esquema</translation>
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
            <translation>{place} ha tallat mentre es feia l'enllaç segur. Si la passarel·la no té TLS, escriviu ws:// en lloc de wss://.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{place} cannot be reached: {reason}. Check network and URL.</source>
            <translation>No s'arriba a {place}: {reason}. Comproveu la xarxa i l'URL.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{place} did not answer in time. Check that the gateway runs, and the network and firewall.</source>
            <translation>{place} no ha respost a temps. Comproveu que la passarel·la funciona, la xarxa i el tallafoc.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} answered HTTP {status} instead of opening a WebSocket. Check that a gateway runs there and what its log says.</source>
            <translation>{url} ha respost HTTP {status} en lloc d'obrir un WebSocket. Comproveu que hi funciona una passarel·la i què diu el seu registre.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} is where robots connect; operators connect to {desk}. Write that instead.</source>
            <translation>{url} és on es connecten els robots; els operadors es connecten a {desk}. Escriviu això.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} refuses this desk: {said}</source>
            <translation>{url} rebutja aquesta consola: {said}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} refuses this desk: {said} Enter the operator's token under Access.</source>
            <translation>{url} rebutja aquesta consola: {said} Introduïu el testimoni de l'operador a Accés.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} takes no desk now: {said} It is tried again by itself.</source>
            <translation>{url} ara no admet cap consola: {said} Es torna a provar sol.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/fleet_state.py" />
            <source>Another site is served now: {site}, no longer {before}. Open its project.</source>
            <translation>Ara se serveix un altre recinte: {site}, ja no {before}. Obriu-ne el projecte.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/fleet_state.py" />
            <source>The gateway has another database than before: its robots and commands are others, and those of before are not shown any more.</source>
            <translation>La passarel·la té una altra base de dades que abans: els seus robots i ordres són uns altres, i els d'abans ja no es mostren.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>Another site, or another fleet, is served now than when this was asked for, and the same numbers are other places there: it was not sent to it. Look at the map, and ask for it again if it is still needed.</source>
            <translation>Ara se serveix un altre recinte, o una altra flota, que quan es va demanar això, i els mateixos nombres hi són altres llocs: no s'hi ha enviat. Mireu el mapa i torneu-ho a demanar si encara cal.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>It was sent before on a link that was lost, and may have been done then: look before you ask again.</source>
            <translation>Ja s'havia enviat per un enllaç que s'ha perdut, i potser es va fer llavors: mireu-ho abans de tornar-ho a demanar.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>No operator can connect at {url}: what answers there knows no desk, as the address of robots does not. A gateway's desk has the path /desk, as in {default_url}. Correct the URL, then press Connect.</source>
            <translation>Cap operador no es pot connectar a {url}: el que hi respon no coneix cap consola, com tampoc l'adreça dels robots. La consola d'una passarel·la té el camí /desk, com a {default_url}. Corregiu l'URL i premeu Connecta.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} refused a message: {error}</source>
            <translation>La passarel·la a {url} ha rebutjat un missatge: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} sends no positions: {error}</source>
            <translation>La passarel·la a {url} no envia posicions: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} serves another fleet than the gateway that named it. Connect to it yourself if that is what you want.</source>
            <translation>La passarel·la de {url} serveix una altra flota que la passarel·la que l'ha anomenada. Connecteu-vos-hi directament si és el que voleu.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} speaks protocol {theirs}, this plugin protocol {ours}. Update whichever of the two is older, then press Connect.</source>
            <translation>La passarel·la a {url} parla el protocol {theirs}, aquest connector el protocol {ours}. Actualitzeu el més antic dels dos i premeu Connecta.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} turned the desk away: {error}</source>
            <translation>La passarel·la a {url} ha rebutjat la consola: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was closed before the gateway answered: whether it arrived is not known. Connect again and look in the command log.</source>
            <translation>L'enllaç s'ha tancat abans que la passarel·la respongués: no se sap si ha arribat. Torneu a connectar i mireu el registre d'ordres.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and it was not sent again: robots were asked to stop after it. If it had arrived before, the command log shows it, and the stop ends it.</source>
            <translation>L'enllaç s'ha perdut abans que la passarel·la respongués, i no s'ha tornat a enviar: després s'ha demanat aturar robots. Si havia arribat abans, surt al registre d'ordres, i l'aturada l'acaba.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: a robot shall not drive off on an old order. Look in the command log and send it again if it is not there.</source>
            <translation>L'enllaç s'ha perdut abans que la passarel·la respongués, i {age:.0f} s després no s'ha repetit: un robot no ha d'arrencar per una ordre antiga. Mireu el registre d'ordres i torneu-la a enviar si no hi és.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: the robot may be doing something else by now. Look at the robot, and ask again if it shall still stop.</source>
            <translation>L'enllaç s'ha perdut abans que la passarel·la respongués, i {age:.0f} s després no s'ha repetit: el robot potser ja fa una altra cosa. Mireu el robot i torneu-ho a demanar si encara s'ha d'aturar.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>the gateway takes no message as large as this one of {size} kB. Ask for less at once, or have largest_message_bytes raised in the site's settings.</source>
            <translation>la passarel·la no accepta cap missatge tan gran com aquest, de {size} kB. Demaneu menys d'una vegada, o feu apujar largest_message_bytes a la configuració del recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Keepouts and obstacles are not watched: the gateway tells nothing of them. It may be older than this plugin.</source>
            <translation>Les zones prohibides i els obstacles no es vigilen: la passarel·la no en diu res. Potser és més antiga que aquest connector.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Keepouts and obstacles are not watched: {why}.</source>
            <translation>Les zones prohibides i els obstacles no es vigilen: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Not judged by keepouts and obstacles, since it is not known where they are: {names}.</source>
            <translation>No jutjats per zones prohibides i obstacles, perquè no se sap on són: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>People near robots are not watched: {why}.</source>
            <translation>No es vigilen les persones a prop dels robots: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>The published site has no keepouts.</source>
            <translation>El recinte publicat no té zones prohibides.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>The published site has no obstacles, so nobody is told to be at one.</source>
            <translation>El recinte publicat no té obstacles, i per això no s'avisa de ningú que hi sigui.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>{more} more</source>
            <translation>{more} més</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>{more} more are in keepouts or at obstacles and not listed.</source>
            <translation>N'hi ha {more} més en zones prohibides o obstacles, sense llistar.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>%n tasks</source>
            <translation>
                <numerusform>%n tasca</numerusform>
                <numerusform>%n tasques</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>, a path of {path_points} points</source>
            <translation>, un camí de {path_points} punts</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>, {deviation:.2f} m off</source>
            <translation>, {deviation:.2f} m de desviació</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>. The robot is {state}: it is sent nothing until it is heard again</source>
            <translation>. El robot és {state}: no se li envia res fins que se'n torni a saber</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>Last: {task} {state} {time}{off}{why}</source>
            <translation>Última: {task} {state} {time}{off}{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>This desk is told of {known} of {all} robots: those in view, selected, or with an alarm.</source>
            <translation>Aquesta consola rep notícies de {known} de {all} robots: els que es veuen al mapa, els seleccionats i els que tenen una alarma.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>aborted</source>
            <translation>avortada</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>acknowledged</source>
            <translation>reconeguda</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>by {by}</source>
            <translation>per {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>collect cone</source>
            <translation>recull con</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>crossing</source>
            <translation>encreuament</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>delivered</source>
            <translation>lliurada</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>drive</source>
            <translation>circula</translation>
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
            <translation>seguiment</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>fresh</source>
            <translation>actual</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>head-on</source>
            <translation>de cara</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>lost</source>
            <translation>perdut</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>nothing to do</source>
            <translation>res a fer</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>now</source>
            <translation>ara</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>offline</source>
            <translation>fora de línia</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>place cone</source>
            <translation>col·loca con</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>queued</source>
            <translation>en cua</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>reached</source>
            <translation>assolida</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>removed</source>
            <translation>treta</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>running</source>
            <translation>en marxa</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>skipped</source>
            <translation>omès</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>stale</source>
            <translation>desactualitzat</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>standing</source>
            <translation>aturat</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>superseded</source>
            <translation>substituïda</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>unsure</source>
            <translation>insegur</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>waiting</source>
            <translation>en espera</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{kind}{name} at {x:.2f}, {y:.2f}{way}</source>
            <translation>{kind}{name} a {x:.2f}, {y:.2f}{way}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{robot}: {count}, PAUSED{when}{why}</source>
            <translation>{robot}: {count}, EN PAUSA{when}{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{state}, may be elsewhere</source>
            <translation>{state}, pot ser en un altre lloc</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source># Help

{file} cannot be read: {strerror}. Install the plugin again.</source>
            <translation># Ajuda

{file} no es pot llegir: {strerror}. Torneu a instal·lar el connector.</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source>Fleet Supervisor help</source>
            <translation>Ajuda del Fleet Supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source>Fleet Supervisor: help</source>
            <translation>Fleet Supervisor: ajuda</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source> (EPSG:326xx north, EPSG:327xx south of the equator)</source>
            <translation> (EPSG:326xx al nord, EPSG:327xx al sud de l'equador)</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>The CRS {crs} cannot carry a site</source>
            <translation>El SRC {crs} no pot portar un recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>The layers are in different CRSs ({names}), and nothing says which is the site's: give SITE_CRS, or set the project's CRS.</source>
            <translation>Les capes són en SRC diferents ({names}), i res no diu quin és el del recinte: doneu SITE_CRS, o definiu el SRC del projecte.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>without a name</source>
            <translation>sense nom</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its coordinates are not metres on a plane. Choose a projected CRS such as the local UTM zone{suggestion}.</source>
            <translation>{named}: les coordenades no són metres en un pla. Trieu un SRC projectat com la zona UTM local{suggestion}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its metres are not metres; 1 m on the ground is 1.56 m there at latitude 50°. Choose the local UTM zone, such as EPSG:32633 for 12°E to 18°E.</source>
            <translation>{named}: els seus metres no són metres; 1 m sobre el terreny hi són 1.56 m a 50° de latitud. Trieu la zona UTM local, com ara EPSG:32633 de 12°E a 18°E.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its unit is {unit}, and robots speak metres. Choose a CRS in metres such as the local UTM zone{suggestion}.</source>
            <translation>{named}: la unitat és {unit}, i els robots parlen en metres. Trieu un SRC en metres com la zona UTM local{suggestion}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source> at ({x:.2f} {y:.2f})</source>
            <translation> a ({x:.2f} {y:.2f})</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/geometry.py" />
            <source>%n different points</source>
            <translation>
                <numerusform>%n punt diferent</numerusform>
                <numerusform>%n punts diferents</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>courtyard {k} of part {number}{place} has {points} and encloses nothing; the courtyard is left out</source>
            <translation>el pati {k} de la part {number}{place} té {points} i no tanca res; el pati queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>has a coordinate that is no number, has no place in the site's CRS or lies beyond 100 000 km; it is left out</source>
            <translation>té una coordenada que no és un nombre, no té lloc en el SRC del recinte o és més enllà de 100 000 km; s'omet</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>has a {kind}, which is no area or line; it is left out</source>
            <translation>té un {kind}, que no és ni àrea ni línia; queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>its corners span no surface that one can drive on; its normal is left out</source>
            <translation>les seves cantonades no formen cap superfície per on es pugui circular; la seva normal queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>line {number} has fewer than two different points; it is left out</source>
            <translation>la línia {number} té menys de dos punts diferents; queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>not valid</source>
            <translation>no és vàlid</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>riser {number} is bent; the straight line between its ends is used</source>
            <translation>el graó {number} és corbat; es fa servir la recta entre els seus extrems</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>the outer ring of part {number}{place} has {points} and encloses nothing; the part is left out</source>
            <translation>l'anell exterior de la part {number}{place} té {points} i no tanca res; la part queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>the polygon is broken{place}: {what}</source>
            <translation>el polígon està trencat{place}: {what}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>{fault}; it cannot be repaired and is left out</source>
            <translation>{fault}; no es pot reparar i queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>{fault}; it was repaired</source>
            <translation>{fault}; s'ha reparat</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>Layer {layer}: it has no field {missing}, which the {what} expression {text!r} reads; the default is used for all its features</source>
            <translation>Capa {layer}: no té el camp {missing}, que llegeix l'expressió de {what} {text!r}; es fa servir el valor per defecte per a totes les seves entitats</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>Layer {layer}: {note}</source>
            <translation>Capa {layer}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>The {what} expression {text!r} for the layer {layer} is not one: {error}. Correct it.</source>
            <translation>L'expressió de {what} {text!r} per a la capa {layer} no ho és: {error}. Corregiu-la.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>The {what} expression {text!r} for the layer {layer} reads the field {missing}, which the layer does not have. Correct it, or write attribute('...') for a field that some layers lack.</source>
            <translation>L'expressió de {what} {text!r} per a la capa {layer} llegeix el camp {missing}, que la capa no té. Corregiu-la, o escriviu attribute('...') per a un camp que falta en algunes capes.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>it is left out</source>
            <translation>queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its base {value!r} is not a number of metres; it is taken to stand on the ground</source>
            <translation>la seva base {value!r} no és un nombre de metres; es pren com si fos a terra</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its filter gives {value!r}, which is neither true nor false; it is left out</source>
            <translation>el seu filtre dona {value!r}, que no és ni cert ni fals; queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its label has letters that cannot be read: set the layer's encoding (Properties &gt; Source), or put a .cpg file beside its shapefile</source>
            <translation>la seva etiqueta té lletres que no es poden llegir: definiu la codificació de la capa (Propietats &gt; Font), o poseu un fitxer .cpg al costat del shapefile</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its outdoor flag {value!r} is neither true nor false; true is used</source>
            <translation>el seu indicador d'exterior {value!r} no és ni cert ni fals; es fa servir cert</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its {what} {value!r} is not a number of metres above 0; the default is used</source>
            <translation>el seu {what} {value!r} no és un nombre de metres superior a 0; es fa servir el valor per defecte</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its {what} {value!r} is not a number of metres of 0 or more; {otherwise}</source>
            <translation>el seu {what} {value!r} no és un nombre de metres de 0 o més; {otherwise}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the default is used</source>
            <translation>es fa servir el valor per defecte</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the estimate is used</source>
            <translation>es fa servir l'estimació</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the {what} expression fails: {error}; {otherwise}</source>
            <translation>l'expressió de {what} falla: {error}; {otherwise}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, feature {id}: {note}</source>
            <translation>Capa {layer}, entitat {id}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, {features}: {note}</source>
            <translation>Capa {layer}, {features}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, {features}; of the first: {note}</source>
            <translation>Capa {layer}, {features}; de la primera: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}: warnings of more kinds about {features}</source>
            <translation>Capa {layer}: avisos de més tipus sobre {features}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be opened ({source}): repair its data source or leave it out.</source>
            <translation>La capa {name} no es pot obrir ({source}): repareu-ne l'origen de dades o ometeu-la.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be read any more: QGIS gets none of its features. Its file or database was moved, damaged or cut off since the project was opened. Bring it back, or repair the layer's data source, and open the project again.</source>
            <translation>La capa {name} ja no es pot llegir: el QGIS no n'obté cap entitat. El fitxer o la base de dades s'ha mogut, s'ha malmès o ha quedat sense connexió des que es va obrir el projecte. Restabliu-lo, o repareu l'origen de dades de la capa, i torneu a obrir el projecte.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be read to its end ({error}): its file is damaged, or was not copied whole. Replace it by a sound copy, or leave the layer out.</source>
            <translation>La capa {name} no es pot llegir fins al final ({error}): el seu fitxer està malmès o no s'ha copiat sencer. Substituïu-lo per una còpia bona o ometeu la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} holds {held}, and only lines and polygons are obstacles: leave it out, give it an extent first (for example with Buffer), or the role furniture.</source>
            <translation>La capa {name} conté {held}, i només les línies i els polígons són obstacles: ometeu-la, doneu-li abans extensió (per exemple amb Buffer), o el paper mobiliari.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>feature {shown}</source>
            <translation>entitat {shown}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>features {shown}</source>
            <translation>entitats {shown}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>features {shown} and {more} more</source>
            <translation>entitats {shown} i {more} més</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>no geometry</source>
            <translation>cap geometria</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>points</source>
            <translation>punts</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: %n heights are not known and estimated as {height:g} m ({features})</source>
            <translation>
                <numerusform>Capa {name}: %n alçada no es coneix i s'estima en {height:g} m ({features})</numerusform>
                <numerusform>Capa {name}: %n alçades no es coneixen i s'estimen en {height:g} m ({features})</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: its role is {role}, yet it is exported as obstacles</source>
            <translation>Capa {name}: el seu paper és {role}, però s'exporta com a obstacles</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: its role {role} wants {wanted}; other features are exported as plain obstacles ({features})</source>
            <translation>Capa {name}: el seu paper {role} vol {wanted}; les altres entitats s'exporten com a simples obstacles ({features})</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>cannot be transformed into the site's CRS ({error}); it is left out</source>
            <translation>no es pot transformar al SRC del recinte ({error}); s'omet</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>has no geometry; it is left out</source>
            <translation>no té geometria; s'omet</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>its rotation {value!r} is not a number of degrees; it is not turned</source>
            <translation>la seva rotació {value!r} no és un nombre de graus; no es gira</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>its width {width:g} m is none of furniture; {used:g} is used</source>
            <translation>la seva amplada de {width:g} m no és de mobiliari; es fa servir {used:g}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>lines, one a riser</source>
            <translation>línies, una per graó</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>polygons</source>
            <translation>polígons</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>{error}; its width is used</source>
            <translation>{error}; es fa servir la seva amplada</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Another publication of {site} into database {database} has ended meanwhile: publish again.</source>
            <translation>Mentrestant ha acabat una altra publicació de {site} a la base de dades {database}: torneu a publicar.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>QGIS has no PostgreSQL connection {name}; it has: {known}. Make it in the browser panel, PostgreSQL &gt; New Connection, or write the address of the database, such as postgresql://account@host/database.</source>
            <translation>El QGIS no té cap connexió PostgreSQL {name}; té: {known}. Creeu-la al tauler del navegador, PostgreSQL &gt; Connexió nova, o escriviu l'adreça de la base de dades, com ara postgresql://account@host/database.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>SITE_ID {site} is too long for a database: give one of at most {most} letters.</source>
            <translation>SITE_ID {site} és massa llarg per a una base de dades: doneu-ne un de {most} lletres com a màxim.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Somebody has read or written {site} in database {database} for more than {seconds} s: wait until another publication has ended, close what shows its layers, and publish again.</source>
            <translation>Algú fa més de {seconds} s que llegeix o escriu {site} a la base de dades {database}: espereu que acabi una altra publicació, tanqueu el que en mostra les capes i torneu a publicar.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Something of yours is made of the views of {site} in database {database}, which stand for one version: {error}. Remove it, publish, and make it again.</source>
            <translation>Alguna cosa vostra es basa en les vistes de {site} a la base de dades {database}, que ara seran unes altres: {error}. Traieu-la, publiqueu i torneu-la a crear.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The PostGIS of database {database} does not know {crs}: choose a SITE_CRS that its table spatial_ref_sys has, or have an administrator add this one there.</source>
            <translation>El PostGIS de la base de dades {database} no coneix {crs}: trieu un SITE_CRS que sigui a la seva taula spatial_ref_sys, o feu que un administrador l'hi afegeixi.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The Python package psycopg2 is missing in this QGIS, which writes to PostgreSQL: {install}</source>
            <translation>En aquest QGIS falta el paquet de Python psycopg2, que escriu a PostgreSQL: {install}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The account {account} may make no schemas in database {database}, and a site is published in some. Its owner runs: {command}</source>
            <translation>El compte {account} no pot crear esquemes a la base de dades {database}, i un recinte s'hi publica. El propietari executa: {command}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The connection to database {database} was lost at the last moment: {site} is published there, or is as it was. Publish again.</source>
            <translation>La connexió amb la base de dades {database} s'ha perdut en l'últim moment: {site} hi és publicat, o és com era. Torneu a publicar.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The database cannot be reached: {error}. Check that it runs, and the host, database, account and password of the connection.</source>
            <translation>No es pot arribar a la base de dades: {error}. Comproveu que funciona, i el servidor, la base de dades, el compte i la contrasenya de la connexió.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The database {database} has no PostGIS. Install the package postgresql-15-postgis-3 (of your version) on the server, and as its administrator run in this database: create extension postgis</source>
            <translation>La base de dades {database} no té PostGIS. Instal·leu al servidor el paquet postgresql-15-postgis-3 (de la vostra versió) i, com a administrador, executeu en aquesta base de dades: create extension postgis</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The schema {schema} of database {database} is of another program, or of another version of this one (it says “{found}”): publish with that, or into another database.</source>
            <translation>L'esquema {schema} de la base de dades {database} és d'un altre programa, o d'una altra versió d'aquest (diu «{found}»): publiqueu amb aquella, o en una altra base de dades.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The site cannot be published in database {database}: {error}. What was published there before is as it was.</source>
            <translation>El recinte no es pot publicar a la base de dades {database}: {error}. El que hi havia publicat és com era.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The sites in database {database} belong to the account {owner}, and not to {account}: publish as {owner}, or have an administrator run: {command}</source>
            <translation>Els recintes de la base de dades {database} són del compte {owner}, i no de {account}: publiqueu com a {owner}, o feu que un administrador executi: {command}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>install the distribution's package, such as python3-psycopg2.</source>
            <translation>instal·leu el paquet de la distribució, com ara python3-psycopg2.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Another publication into {folder} is under way, by {who}: wait until it has ended, or choose another folder. If it ended on another computer without a word, remove {file}.</source>
            <translation>Una altra publicació a {folder} és en curs, de {who}: espereu que acabi, o trieu una altra carpeta. Si va acabar en un altre ordinador sense dir res, esborreu {file}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Keepouts</source>
            <translation>Zones prohibides</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Obstacles</source>
            <translation>Obstacles</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Publish the site again.</source>
            <translation>Torneu a publicar el recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Road centrelines</source>
            <translation>Eixos de via</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Road surfaces</source>
            <translation>Superfícies de via</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>The site cannot be published in {folder}: {file} is a file. Choose a folder: a new one, or the one that the site was published in before.</source>
            <translation>El recinte no es pot publicar a {folder}: {file} és un fitxer. Trieu una carpeta: una de nova o la mateixa on ja es va publicar el recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>The site cannot be published in {folder}: {reason}. Check the folder's rights and the free space.</source>
            <translation>El recinte no es pot publicar a {folder}: {reason}. Comproveu els permisos de la carpeta i l'espai lliure.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>another process</source>
            <translation>un altre procés</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>no file {lock_file} can be made in it</source>
            <translation>no s'hi pot crear cap fitxer {lock_file}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>process {process} on {host}</source>
            <translation>el procés {process} a {host}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} cannot be read: {error}</source>
            <translation>{file} no es pot llegir: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} has no layer {layers} that can be read. {again}</source>
            <translation>{file} no té cap capa {layers} que es pugui llegir. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} is there and is no part of a published site: choose another folder, or say that it may be replaced (REPLACE=true).</source>
            <translation>{file} hi és i no forma part d'un recinte publicat: trieu una altra carpeta, o digueu que es pot substituir (REPLACE=true).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} names no site: it has no table [site] with a name. {again}</source>
            <translation>{file} no anomena cap recinte: no té la taula [site] amb un nom. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{folder} has a {settings} and no {geopackage}. {again}</source>
            <translation>{folder} té {settings} i no {geopackage}. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{folder} holds version {version} of another site, {other}: choose another folder for {site}, or say that the other site may be replaced (REPLACE=true).</source>
            <translation>{folder} conté la versió {version} d'un altre recinte, {other}: trieu una altra carpeta per a {site}, o digueu que l'altre recinte es pot substituir (REPLACE=true).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>GDAL does not say why</source>
            <translation>GDAL no diu per què</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>The Python bindings of GDAL (osgeo) are missing in this QGIS, which write site.gpkg: install the distribution's package, such as python3-gdal.</source>
            <translation>En aquest QGIS falten els enllaços de Python de GDAL (osgeo), que escriuen site.gpkg: instal·leu el paquet de la distribució, com ara python3-gdal.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>{file} cannot be written in {folder}: {error}. Check the folder's rights and the free space.</source>
            <translation>{file} no es pot escriure a {folder}: {error}. Comproveu els permisos de la carpeta i l'espai lliure.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/reading.py" />
            <source>The layer {layer} has not answered for {seconds:g} s. Bring its server or drive back and try again.</source>
            <translation>La capa {layer} no respon des de fa {seconds:g} s. Restabliu-ne el servidor o la unitat i torneu-ho a provar.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>Layer {layer}: the width of {count} of its roads is not known and taken as {width:g} m (feature {first} is the first)</source>
            <translation>Capa {layer}: l'amplada de {count} de les seves vies no es coneix i es pren com a {width:g} m (l'entitat {first} és la primera)</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>has a line, which is no area; it is left out</source>
            <translation>té una línia, que no és una àrea; queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>has a polygon, which is no centreline; it is left out</source>
            <translation>té un polígon, que no és un eix de via; queda fora</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its direction {value!r} is none of yes, -1 and no; it is taken as driven both ways</source>
            <translation>el seu sentit {value!r} no és yes, -1 ni no; es pren com a doble sentit</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its level {value!r} is no number; it is taken to be on the ground</source>
            <translation>el seu nivell {value!r} no és un nombre; es pren com si fos a terra</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its speed {value!r} is no number above 0; the default is used</source>
            <translation>la seva velocitat {value!r} no és un nombre superior a 0; es fa servir el valor per defecte</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>none of its fields direction, oneway, one_way and other_tags is there to tell one-way roads; all are taken as driven both ways</source>
            <translation>no hi ha cap dels camps direction, oneway, one_way i other_tags que digui quines vies són de sentit únic; totes es prenen com de doble sentit</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>whether it is closed, {value!r}, is neither true nor false; it is taken as closed</source>
            <translation>si és tancada, {value!r}, no és ni cert ni fals; es pren com a tancada</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_surfaces.py" />
            <source>the road surfaces are still being read ({layers}): try again soon</source>
            <translation>les superfícies de via encara s'estan llegint ({layers}): torneu-ho a provar aviat</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n keepouts</source>
            <translation>
                <numerusform>%n zona prohibida</numerusform>
                <numerusform>%n zones prohibides</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n layers refused</source>
            <translation>
                <numerusform>%n capa rebutjada</numerusform>
                <numerusform>%n capes rebutjades</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n obstacles</source>
            <translation>
                <numerusform>%n obstacle</numerusform>
                <numerusform>%n obstacles</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n roads</source>
            <translation>
                <numerusform>%n via</numerusform>
                <numerusform>%n vies</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n segments</source>
            <translation>
                <numerusform>%n segment</numerusform>
                <numerusform>%n segments</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n surfaces</source>
            <translation>
                <numerusform>%n superfície</numerusform>
                <numerusform>%n superfícies</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n warnings</source>
            <translation>
                <numerusform>%n avís</numerusform>
                <numerusform>%n avisos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>Preview of the site</source>
            <translation>Vista prèvia del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>refused</source>
            <translation>rebutjada</translation>
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
            <translation>Resultat</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Estimate [m]</source>
            <translation>Estimació [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for metres above the ground where it begins, as of an arch; empty: 0</source>
            <translation>Expressió per als metres sobre el terra on comença, com un arc; buida: 0</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for metres from the foot up; empty: the field height or height_m</source>
            <translation>Expressió per als metres des del peu cap amunt; buida: el camp height o height_m</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the degrees clockwise that the template is turned; empty: 0</source>
            <translation>Expressió per als graus que es gira la plantilla en sentit horari; buida: 0</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the height where it is not known, such as 3 * "levels"; marked as estimated</source>
            <translation>Expressió per a l'alçada on no es coneix, com ara 3 * "levels"; marcada com a estimada</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the label, such as 'building,' || "name"; of a road its surface</source>
            <translation>Expressió per a l'etiqueta, com ara 'building,' || "name"; d'una via, la superfície</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the metres across, of a road or of furniture that is points</source>
            <translation>Expressió per als metres d'amplada, d'una via o de mobiliari que són punts</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the shape that a point of furniture stands for: {shapes}, 'circle 0.6', 'square 1' or 'rectangle 2 0.5'; empty: an octagon of its width</source>
            <translation>Expressió per a la forma que representa un punt de mobiliari: {shapes}, 'circle 0.6', 'square 1' o 'rectangle 2 0.5'; buida: un octàgon de la seva amplada</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for true or false; empty: true</source>
            <translation>Expressió per a cert o fals; buida: cert</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression that is true of the features that count, such as "amenity" = 'bench'; empty: all</source>
            <translation>Expressió certa per a les entitats que compten, com ara "amenity" = 'bench'; buida: totes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Filter</source>
            <translation>Filtre</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Foot [m]</source>
            <translation>Peu [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Height [m]</source>
            <translation>Alçada [m]</translation>
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
            <translation>Capes del projecte que poden tenir un paper</translation>
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
            <translation>Girat [°]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>What is published of the layer</source>
            <translation>Què es publica de la capa</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>What the layer is to robots and operators</source>
            <translation>Què és la capa per als robots i els operadors</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Width [m]</source>
            <translation>Amplada [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>furniture</source>
            <translation>mobiliari</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>keepout</source>
            <translation>zona prohibida</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>obstacle</source>
            <translation>obstacle</translation>
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
            <translation>eix de via</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>road surface</source>
            <translation>superfície de via</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>stairs</source>
            <translation>escala</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Apply profile</source>
            <translation>Aplica el perfil</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Layer roles</source>
            <translation>Papers de les capes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Layer roles…</source>
            <translation>Papers de les capes…</translation>
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
            <translation>Perfil d'un fitxer…</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Reading %n layers …</source>
            <translation>
                <numerusform>S'està llegint %n capa …</numerusform>
                <numerusform>S'estan llegint %n capes …</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Say what each layer of the project is to robots</source>
            <translation>Digueu què és cada capa del projecte per als robots</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>{name} knows none of these layers. It looks for layers that are named, in their source or in the project: {sought}.</source>
            <translation>{name} no coneix cap d'aquestes capes. Cerca capes que, a l'origen o al projecte, s'anomenin: {sought}.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>{name}: {known} of %n layers set up.</source>
            <translation>
                <numerusform>{name}: {known} de %n capa configurada.</numerusform>
                <numerusform>{name}: {known} de %n capes configurades.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>The profile {file} cannot be read: {error}.</source>
            <translation>El perfil {file} no es pot llegir: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>The profile {file} is not there: give the path of a file, or one of {shipped}.</source>
            <translation>El perfil {file} no hi és: doneu el camí d'un fitxer, o un de {shipped}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>it has {count} characters, more than {most}</source>
            <translation>té {count} caràcters, més de {most}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} cannot be read: this QGIS runs Python older than 3.11, which reads no TOML. Save the profile with the same keys as JSON and choose that file.</source>
            <translation>{file} no es pot llegir: aquest QGIS fa servir un Python anterior a 3.11, que no llegeix TOML. Deseu el perfil amb les mateixes claus com a JSON i trieu aquell fitxer.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} is no profile: write an object with name and layers.</source>
            <translation>{file} no és un perfil: escriviu un objecte amb name i layers.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} is not valid {kind}: {error}. Correct that place.</source>
            <translation>{file} no és {kind} vàlid: {error}. Corregiu aquest lloc.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: layers is missing or empty: write one table [[layers]] or more.</source>
            <translation>{file}: layers falta o és buit: escriviu una o més taules [[layers]].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key} fits no layer: write names = ["*building*"] or fields = ["building"].</source>
            <translation>{file}: {key} no encaixa amb cap capa: escriviu names = ["*building*"] o fields = ["building"].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key} is {content!r}: write a table [[layers]].</source>
            <translation>{file}: {key} és {content!r}: escriviu una taula [[layers]].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.geometry is {geometry!r}: write one of {geometries}.</source>
            <translation>{file}: {key}.geometry és {geometry!r}: escriviu un de {geometries}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.role is {role!r}: write one of {roles}.</source>
            <translation>{file}: {key}.role és {role!r}: escriviu un de {roles}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.{name} is no QGIS expression: {error}. Correct it.</source>
            <translation>{file}: {key}.{name} no és una expressió de QGIS: {error}. Corregiu-la.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.{name} is {value!r}: write a list of texts, such as ["walls"].</source>
            <translation>{file}: {key}.{name} és {value!r}: escriviu una llista de textos, com ara ["walls"].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {prefix}{name} is no key of a profile: known are {known}. Remove it or correct its name.</source>
            <translation>{file}: {prefix}{name} no és una clau de perfil: les conegudes són {known}. Traieu-la o corregiu-ne el nom.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {prefix}{name} is {value!r}: write text in quotes.</source>
            <translation>{file}: {prefix}{name} és {value!r}: escriviu text entre cometes.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{names} with {fields}</source>
            <translation>{names} amb {fields}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>A position in {crs} has no place in {target} ({error}). Choose the site's CRS as the project's CRS (bottom right in the QGIS window).</source>
            <translation>Una posició en {crs} no té lloc a {target} ({error}). Trieu el SRC del recinte com a SRC del projecte (a baix a la dreta de la finestra de QGIS).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>A way accurate to {accuracy:g} m needs the grid {grids}, which is not installed.</source>
            <translation>Una via amb exactitud de {accuracy:g} m necessita la malla {grids}, que no està instal·lada.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>By {name} ({exact}).{warning}</source>
            <translation>Per {name} ({exact}).{warning}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>Layer {layer}: its features may lie metres off on the site. They come from {crs} to {site_crs}. {way} Choose another transformation in the project's properties, or save the layer in the site's CRS by an exact one.</source>
            <translation>Capa {layer}: les seves entitats poden quedar a metres del seu lloc en el recinte. Passen de {crs} a {site_crs}. {way} Trieu una altra transformació a les propietats del projecte, o deseu la capa en el SRC del recinte amb una d'exacta.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>PROJ knows no exact way between these two: the place may be off by metres.</source>
            <translation>PROJ no coneix cap via exacta entre aquests dos: el lloc pot fallar per metres.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} has no CRS, so its place is not known: set the layer's CRS (Layer &gt; Set CRS of Layer).</source>
            <translation>La capa {name} no té SRC, per això no se'n coneix el lloc: definiu el SRC de la capa (Capa &gt; Defineix el SRC de la capa).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} has no CRS, so its place on the site is not known: set the layer's CRS (Layer &gt; Set CRS of Layer), or {tick}.</source>
            <translation>La capa {name} no té SRC, així que el seu lloc al recinte no es coneix: definiu el SRC de la capa (Capa &gt; Defineix el SRC de la capa), o {tick}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} is in the CRS {crs}, which has no known relation to the CRS {site_crs}: give both layers a CRS that says where on the Earth they are.</source>
            <translation>La capa {name} és en el SRC {crs}, que no té cap relació coneguda amb el SRC {site_crs}: doneu a les dues capes un SRC que digui on són a la Terra.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} is in the CRS {crs}, which has no known relation to the site CRS {site_crs}: choose the layer's CRS as the site CRS, or {tick}.</source>
            <translation>La capa {name} és en el SRC {crs}, que no té cap relació coneguda amb el SRC del recinte {site_crs}: trieu el SRC de la capa com a SRC del recinte, o {tick}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The site is not known yet. Connect to a gateway first.</source>
            <translation>El recinte encara no es coneix. Connecteu abans a una passarel·la.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The site {name} is in the CRS {crs}, which this QGIS does not know: its robots cannot be placed on the map. Correct crs in the site's site.toml, or update QGIS.</source>
            <translation>El recinte {name} és en el SRC {crs}, que aquest QGIS no coneix: els seus robots no es poden situar al mapa. Corregiu crs al site.toml del recinte, o actualitzeu QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>There is no way from {site} to {crs}. Choose another CRS under Columns.</source>
            <translation>No hi ha cap via de {site} a {crs}. Trieu un altre SRC a Columnes.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>accuracy not known</source>
            <translation>exactitud desconeguda</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>accurate to {accuracy:g} m</source>
            <translation>exactitud de {accuracy:g} m</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>exact</source>
            <translation>exacte</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>no change: it is the site's CRS</source>
            <translation>cap canvi: és el SRC del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>not a finite place</source>
            <translation>no és un lloc finit</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>nothing is known of how the two lie to each other</source>
            <translation>no se sap com es relacionen l'un amb l'altre</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>site frame</source>
            <translation>marc del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>the default operation of PROJ</source>
            <translation>l'operació per defecte de PROJ</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>tick 'Layers without a CRS are in metres of the site' (LOCAL=true)</source>
            <translation>marqueu «Les capes sense SRC són en metres del recinte» (LOCAL=true)</translation>
        </message>
        <message>
            <location filename="../../plugin/locator.py" />
            <source>Robots</source>
            <translation>Robots</translation>
        </message>
        <message>
            <location filename="../../plugin/locator.py" />
            <source>{state}, heard of {age:.0f} s ago</source>
            <translation>{state}, últim missatge fa {age:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>All robots cannot be followed.</source>
            <translation>No es poden seguir tots els robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>No robot is selected to be followed. Select one in the table or on the map.</source>
            <translation>No hi ha cap robot seleccionat per seguir. Seleccioneu-ne un a la taula o al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>{robot} has not said yet where it is; the map cannot go there.</source>
            <translation>{robot} encara no ha dit on és; el mapa no hi pot anar.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>, {remaining:.1f} m to go</source>
            <translation>, falten {remaining:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>accuracy</source>
            <translation>precisió</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>battery</source>
            <translation>bateria</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>heading</source>
            <translation>rumb</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>it says</source>
            <translation>diu</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>last message</source>
            <translation>últim missatge</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>place</source>
            <translation>lloc</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>speed</source>
            <translation>velocitat</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>task</source>
            <translation>tasca</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>why</source>
            <translation>per què</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{age_in_words} ago, {escape}</source>
            <translation>fa {age_in_words}, {escape}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{v:.2f} m/s</source>
            <translation>{v:.2f} m/s</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{x:.2f}, {y:.2f} m in the site</source>
            <translation>{x:.2f}, {y:.2f} m al recinte</translation>
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
                <numerusform>%n robot aquí, mostrat com a densitat; amplieu el mapa per veure'l</numerusform>
                <numerusform>%n robots aquí, mostrats com a densitat; amplieu el mapa per veure'ls un a un</numerusform>
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
            <translation>· fora de línia</translation>
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
            <translation>Antiguitat (s)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Battery (0 to 1)</source>
            <translation>Bateria (0 a 1)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Closed roads</source>
            <translation>Vies tancades</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Command</source>
            <translation>Ordre</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Cones put down</source>
            <translation>Cons posats</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Conflicts</source>
            <translation>Conflictes</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Heading (°)</source>
            <translation>Rumb (°)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Link</source>
            <translation>Enllaç</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Robot</source>
            <translation>Robot</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Robots (live)</source>
            <translation>Robots (en directe)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Speed (m/s)</source>
            <translation>Velocitat (m/s)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Status</source>
            <translation>Situació</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Theta (rad)</source>
            <translation>Theta (rad)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>closed</source>
            <translation>tancada</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>until</source>
            <translation>fins a</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Close road</source>
            <translation>Tanca via</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Closed</source>
            <translation>Tancada</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Open it again for every robot?</source>
            <translation>Voleu tornar a obrir-la a tots els robots?</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Open road</source>
            <translation>Obre la via</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Reason</source>
            <translation>Motiu</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>The road is closed for every robot from this junction to the next. Robots whose way leads along it get another way; one that has no other way is stopped, unless the site's settings say otherwise.</source>
            <translation>La via es tanca a tots els robots des d'aquesta cruïlla fins a la següent. Els que hi havien de passar reben un altre recorregut; el que no en té cap altre s'atura, si la configuració del recinte no diu una altra cosa.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 1 hour</source>
            <translation>durant 1 hora</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 15 minutes</source>
            <translation>durant 15 minuts</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 4 hours</source>
            <translation>durant 4 hores</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>such as: tree on the road</source>
            <translation>com ara: arbre a la via</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>until it is opened</source>
            <translation>fins que s'obri</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>{by} closed this road at {time}{because}</source>
            <translation>{by} va tancar aquesta via a les {time}{because}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>No robot is selected, so there is nobody to send there. Select one in the table or on the map.</source>
            <translation>No hi ha cap robot seleccionat, així que no hi ha qui enviar-hi. Seleccioneu-ne un a la taula o al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>Select a robot first, in the table or on the map.</source>
            <translation>Seleccioneu abans un robot, a la taula o al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>The site or the map's CRS has changed meanwhile. Draw the start position again.</source>
            <translation>Mentrestant ha canviat el recinte o el SRC del mapa. Torneu a dibuixar la posició inicial.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>There is nothing to do again.</source>
            <translation>No hi ha res a refer.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>There is nothing to take back.</source>
            <translation>No hi ha res a desfer.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>{in_words} is still on the map. Send it (Enter) or cancel it (Esc) first.</source>
            <translation>{in_words} encara és al mapa. Envieu-ho (Retorn) o cancel·leu-ho (Esc) abans.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>No layer of the project has the role road surface: set it in Plugins &gt; Fleet Supervisor &gt; Layer roles.</source>
            <translation>Cap capa del projecte té el paper superfície de via: poseu-lo a Connectors &gt; Fleet Supervisor &gt; Papers de les capes.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>No road surface</source>
            <translation>Cap superfície de via</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>Tell the road surface under the cursor; a click says it with its coordinates, Esc ends</source>
            <translation>Diu la superfície de via sota el cursor; un clic la diu amb les coordenades, Esc acaba</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>The ways to the %n places clicked last were not known yet, so they are not in the route.</source>
            <translation>
                <numerusform>Encara no se sabia el camí fins a %n lloc on heu fet l'últim clic, de manera que no és a la ruta.</numerusform>
                <numerusform>Encara no se sabien els camins fins als %n llocs on heu fet els últims clics, de manera que no són a la ruta.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>This leg does not follow the roads: {note}</source>
            <translation>Aquest tram no segueix les vies: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>Which road surface is here?</source>
            <translation>Quina superfície de via hi ha aquí?</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>no CRS</source>
            <translation>sense SRC</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>no road surface</source>
            <translation>cap superfície de via</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>road surface without a class</source>
            <translation>superfície de via sense classe</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>{surface} at {where}</source>
            <translation>{surface} a {where}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>{why} (Nor are the %n places clicked after it in the route.)</source>
            <translation>
                <numerusform>{why} (Tampoc no és a la ruta %n lloc on heu fet clic després.)</numerusform>
                <numerusform>{why} (Tampoc no són a la ruta els %n llocs on heu fet clic després.)</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>A route needs at least two points, so its drawing goes on: click the next one.</source>
            <translation>Una ruta necessita almenys dos punts, així que el dibuix continua: feu clic al següent.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Keep off roads on which other robots are sent</source>
            <translation>Evita les vies per on s'han enviat altres robots</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Lead ways so</source>
            <translation>Porta-ho així</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Surfaces</source>
            <translation>Superfícies</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>The route on the map is for {robot}, but {selected} is selected. Send it (Enter) or cancel it (Esc) first, or select {robot} again.</source>
            <translation>La ruta del mapa és per a {robot}, però el seleccionat és {selected}. Envieu-la (Retorn) o cancel·leu-la (Esc) primer, o torneu a seleccionar {robot}.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>This holds for every leg that is led from now on, until QGIS is closed.</source>
            <translation>Això val per a cada tram que es traci d'ara endavant, fins que es tanqui el QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>This is the first vertex: another is put before one that comes later.</source>
            <translation>Aquest és el primer vèrtex: se'n posa un altre davant d'un que ve després.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Way</source>
            <translation>Recorregut</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Ways on roads</source>
            <translation>Camins per vies</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Width</source>
            <translation>Amplada</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>all, or such as: asphalt, concrete</source>
            <translation>totes, o com ara: asphalt, concrete</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>as wide as the robots are</source>
            <translation>tan ampla com els robots</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>the fastest</source>
            <translation>el més ràpid</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>the shortest</source>
            <translation>el més curt</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Accept</source>
            <translation>Accepta</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>All are reviewed.</source>
            <translation>Totes estan revisades.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>An image of {object}, told by {robot}, at {x:.2f}, {y:.2f} m.</source>
            <translation>Una imatge de {object}, enviada per {robot}, a {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>An object: {object}, told by {robot}, at {x:.2f}, {y:.2f} m.</source>
            <translation>Un objecte: {object}, comunicat per {robot}, a {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Draw it on no map</source>
            <translation>No el dibuixis a cap mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Go to it on the map</source>
            <translation>Hi va al mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Height</source>
            <translation>Alçada</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is a</source>
            <translation>És un</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is gone: leave it out of the maps that robots get from now on</source>
            <translation>Ja no hi és: no surt en els mapes que els robots rebin a partir d’ara</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is there: leave it on the maps</source>
            <translation>Hi és: queda en els mapes</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It stands there: draw it on the maps that robots get from now on</source>
            <translation>És allà: dibuixa'l als mapes que els robots rebin a partir d'ara</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It waits for your review.</source>
            <translation>Espera la vostra revisió.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Look at it: is it of use?</source>
            <translation>Mireu-la: és útil?</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>No robot has told of an object or image yet.</source>
            <translation>Cap robot no ha informat encara d'un objecte o d'una imatge.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Not there any more? {robot} looks through {what} ({source}) of its map again and again, at {x:.2f}, {y:.2f} m.</source>
            <translation>Ja no hi és? {robot} veu una vegada i una altra a través de {what} ({source}) del seu mapa, a {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Objects and images that robots told of, to be accepted for the maps or rejected</source>
            <translation>Objectes i imatges de què han informat els robots, per acceptar-los als mapes o rebutjar-los</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observation {number} was not reviewed: {why}</source>
            <translation>L'observació {number} no s'ha revisat: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observation {observation} was NOT reviewed: {error}</source>
            <translation>L'observació {observation} NO s'ha revisat: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observations</source>
            <translation>Observacions</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observations ({waiting})</source>
            <translation>Observacions ({waiting})</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Radius</source>
            <translation>Radi</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Reject</source>
            <translation>Rebutja</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Show</source>
            <translation>Mostra</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Show reviewed ones, too</source>
            <translation>Mostra també les revisades</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>State: {state}, by {by}. A new review takes the place of that.</source>
            <translation>Estat: {state}, per {by}. Una revisió nova la substitueix.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>State: {state}. A new review takes the place of that.</source>
            <translation>Estat: {state}. Una revisió nova la substitueix.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>not known</source>
            <translation>no se sap</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>object</source>
            <translation>objecte</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>optional</source>
            <translation>opcional</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>{waiting} to be reviewed</source>
            <translation>{waiting} per revisar</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>Observation {number} at {x:.2f}, {y:.2f} m; double click goes there</source>
            <translation>Observació {number} a {x:.2f}, {y:.2f} m; un doble clic hi va</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>What robots saw is not known: {error}</source>
            <translation>No se sap què han vist els robots: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>accepted</source>
            <translation>acceptada</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>image</source>
            <translation>imatge</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>not there any more: {what}</source>
            <translation>ja no hi és: {what}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>rejected</source>
            <translation>rebutjada</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>to be reviewed</source>
            <translation>per revisar</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>{state} by {by}</source>
            <translation>{state} per {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>&amp;Folder for files that are written</source>
            <translation>&amp;Carpeta dels fitxers que s'escriuen</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>&amp;Size of robots on the map</source>
            <translation>&amp;Mida dels robots al mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>1 is as they come</source>
            <translation>1 és la mida original</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Alarms</source>
            <translation>Alarmes</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Arrows show how each robot is, and move with every position. The layer shows what its style says, as often as it is written anew; while it is not on the map there are arrows</source>
            <translation>Les fletxes mostren com està cada robot i es mouen amb cada posició. La capa mostra el que diu el seu estil, tan sovint com es torna a escriure; mentre no és al mapa hi ha fletxes</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>At most; from the next connection on. Fewer spare a slow network</source>
            <translation>Com a màxim; a partir de la propera connexió. Menys descarreguen una xarxa lenta</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Connections</source>
            <translation>Connexions</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Fleet Supervisor &amp;help</source>
            <translation>&amp;Ajuda del Fleet Supervisor</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Layer of robots written anew &amp;every</source>
            <translation>La capa de robots es torna a escriure &amp;cada</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Map and files</source>
            <translation>Mapa i fitxers</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Positions asked for, &amp;times a second</source>
            <translation>Posicions demanades, &amp;vegades per segon</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Robots are &amp;drawn by</source>
            <translation>Qui &amp;dibuixa els robots</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>The layer Robots (live): attribute table, labels, expressions. The live map goes its own way</source>
            <translation>La capa Robots (en directe): taula d'atributs, etiquetes, expressions. El mapa en viu va per una altra banda</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>the layer Robots (live), in its style</source>
            <translation>la capa Robots (en directe), amb el seu estil</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>the live map: arrows</source>
            <translation>el mapa en viu: fletxes</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>your documents</source>
            <translation>els vostres documents</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>%n lines written to {path}</source>
            <translation>
                <numerusform>%n línia escrita a {path}</numerusform>
                <numerusform>%n línies escrites a {path}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Acknowledge</source>
            <translation>Reconeix</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Acknowledge all</source>
            <translation>Reconeix-les totes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Alarm</source>
            <translation>Alarma</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Alarm settings</source>
            <translation>Configuració de les alarmes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>By</source>
            <translation>Qui</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>CSV (*.csv)</source>
            <translation>CSV (*.csv)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Every alarm of this session, and who acknowledged it when</source>
            <translation>Totes les alarmes de la sessió, i qui les va reconèixer i quan</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Export CSV…</source>
            <translation>Exporta CSV…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Export the log of alarms</source>
            <translation>Exporta el registre d'alarmes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Kind</source>
            <translation>Tipus</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Log of alarms</source>
            <translation>Registre d'alarmes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Log…</source>
            <translation>Registre…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Say that you have seen every alarm</source>
            <translation>Digueu que heu vist totes les alarmes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Say that you have seen the chosen alarms</source>
            <translation>Digueu que heu vist les alarmes triades</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Settings…</source>
            <translation>Configuració…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Time</source>
            <translation>Hora</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>What</source>
            <translation>Què</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>What is an alarm, and from where on</source>
            <translation>Què és una alarma, i a partir d'on</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>acknowledged {time} by {operator}</source>
            <translation>reconeguda a les {time} per {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>it began {times} times</source>
            <translation>ha començat {times} vegades</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>over</source>
            <translation>acabada</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>over since {time}, not acknowledged yet</source>
            <translation>acabada des de les {time}, encara sense reconèixer</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>since {time}</source>
            <translation>des de les {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>the gateway judges it by the published site, and says what it does</source>
            <translation>la passarel·la ho jutja segons el recinte publicat i diu què fa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>the site's settings say after how long (see the robots' state)</source>
            <translation>la configuració del recinte diu al cap de quant (vegeu l'estat dels robots)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source> at {x:.1f}, {y:.1f} m</source>
            <translation> a {x:.1f}, {y:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>began</source>
            <translation>començada</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>ended</source>
            <translation>acabada</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it could NOT be stopped yet: {why}</source>
            <translation>encara NO s'ha pogut aturar: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it is being aborted</source>
            <translation>s'està avortant</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it is being paused</source>
            <translation>s'està posant en pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>new</source>
            <translation>nova</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>seen</source>
            <translation>vista</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the emergency stop holds it</source>
            <translation>la parada d'emergència el reté</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the gateway has aborted its task</source>
            <translation>la passarel·la n'ha avortat la tasca</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the gateway has paused it</source>
            <translation>la passarel·la l'ha posat en pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} and {other}</source>
            <translation>{robot} i {other}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} is at the obstacle {name}</source>
            <translation>{robot} és a l'obstacle {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} is in the keepout {name}</source>
            <translation>{robot} és a la zona prohibida {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} will pass {other} at {metres:.1f} m (clearance {clearance:.1f} m){where}</source>
            <translation>{robot} passarà a {metres:.1f} m de {other} (distància mínima {clearance:.1f} m){where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} will pass {other} at {metres:.1f} m{where}</source>
            <translation>{robot} passarà a {metres:.1f} m de {other}{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{seen} comes within {metres:.1f} m of {robot} in {seconds:.0f} s</source>
            <translation>{seen} serà a menys de {metres:.1f} m de {robot} d’aquí a {seconds:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{seen} is {metres:.1f} m from {robot}</source>
            <translation>{seen} és a {metres:.1f} m de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{text} (it is not heard now)</source>
            <translation>{text} (ara no se'l sent)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{text}; {robot} may be elsewhere</source>
            <translation>{text}; {robot} pot ser en un altre lloc</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>; last{where}</source>
            <translation>; l'últim cop{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>at an obstacle</source>
            <translation>en un obstacle</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins after standing with a task for</source>
            <translation>comença després d'estar aturat amb una tasca durant</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins below</source>
            <translation>comença per sota de</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so far beside the road</source>
            <translation>comença tant al costat de la via</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so far outside</source>
            <translation>comença tant fora</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so long before</source>
            <translation>comença aquest temps abans</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins when less exact than</source>
            <translation>comença quan és menys exacta que</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins when two are nearer than</source>
            <translation>comença quan dos són més a prop de</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much above that</source>
            <translation>acaba tant per sobre</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much below that</source>
            <translation>acaba tant per sota</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much further apart</source>
            <translation>acaba tant més lluny</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>in a keepout</source>
            <translation>en una zona prohibida</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>low battery</source>
            <translation>bateria baixa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>near a robot</source>
            <translation>a prop d’un robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>off the road</source>
            <translation>fora de la via</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>outside the site</source>
            <translation>fora del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>stopped unasked</source>
            <translation>aturat sense demanar-ho</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>too close</source>
            <translation>massa a prop</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>unsure of its place</source>
            <translation>insegur del seu lloc</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>will come near a robot</source>
            <translation>s’acostarà a un robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>will pass too near</source>
            <translation>passarà massa a prop</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} and {other} are {apart:.1f} m apart{where}</source>
            <translation>{robot} i {other} són a {apart:.1f} m l'un de l'altre{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} does not know its place: ± {accuracy:.1f} m{where}</source>
            <translation>{robot} no sap on és: ± {accuracy:.1f} m{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} has a task and stands{where}</source>
            <translation>{robot} té una tasca i està aturat{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} has {part:.0%} of its battery left</source>
            <translation>a {robot} li queda el {part:.0%} de la bateria</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is lost: nothing is heard of it{last}</source>
            <translation>{robot} és perdut: no se'n sap res{last}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is off the road{where}</source>
            <translation>{robot} és fora de la via{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is outside the site{where}</source>
            <translation>{robot} és fora del recinte{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} may not be where it is shown: {why}</source>
            <translation>{robot} pot no ser on es mostra: {why}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>%n alarms</source>
            <translation>
                <numerusform>%n alarma</numerusform>
                <numerusform>%n alarmes</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Nothing is watched: the desk is not connected.</source>
            <translation>No es vigila res: la consola no està connectada.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Off the road is not watched: {why}.</source>
            <translation>No es vigila si surten de la via: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Switched off: {kinds}.</source>
            <translation>Desactivades: {kinds}.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>and %n more alarms: see the log of alarms in the Fleet panel</source>
            <translation>
                <numerusform>i %n alarma més: vegeu el registre d'alarmes al tauler de la flota</numerusform>
                <numerusform>i %n alarmes més: vegeu el registre d'alarmes al tauler de la flota</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>layers of road surfaces cannot be read: {why}</source>
            <translation>les capes de superfícies de via no es poden llegir: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>layers of road surfaces hold no areas ({names})</source>
            <translation>les capes de superfícies de via no tenen àrees ({names})</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>no layer of the project has the role road surface</source>
            <translation>cap capa del projecte té el paper superfície de via</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>the road surfaces are being read</source>
            <translation>s'estan llegint les superfícies de via</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>this desk</source>
            <translation>aquesta consola</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n commands</source>
            <translation>
                <numerusform>%n ordre</numerusform>
                <numerusform>%n ordres</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n older commands came.</source>
            <translation>
                <numerusform>Ha arribat %n ordre més antiga.</numerusform>
                <numerusform>Han arribat %n ordres més antigues.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n steps</source>
            <translation>
                <numerusform>%n pas</numerusform>
                <numerusform>%n passos</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>All commands</source>
            <translation>Totes les ordres</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>All robots</source>
            <translation>Tots els robots</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Ask the gateway for older commands</source>
            <translation>Demana a la passarel·la ordres més antigues</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Commands</source>
            <translation>Ordres</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Export commands</source>
            <translation>Exporta les ordres</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Export…</source>
            <translation>Exporta…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Failed, aborted, expired</source>
            <translation>Fallides, avortades, caducades</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Go there</source>
            <translation>Vés-hi</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>No older commands came.</source>
            <translation>No ha arribat cap ordre més antiga.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>None open</source>
            <translation>Cap d'oberta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older</source>
            <translation>Més antigues</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older commands: the gateway has not answered for {seconds:g} s. Press Older to ask once more.</source>
            <translation>Ordres més antigues: la passarel·la no ha respost des de fa {seconds:g} s. Premeu Més antigues per tornar-ho a preguntar.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older commands: {why}</source>
            <translation>Ordres més antigues: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Open</source>
            <translation>Obertes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Selected robots</source>
            <translation>Robots seleccionats</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Show where the chosen command leads to (double click)</source>
            <translation>Mostra on porta l'ordre triada (doble clic)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>The gateway knows no others.</source>
            <translation>La passarel·la no en coneix cap altra.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>The log reaches no further back: the newest {asked} of each chosen robot, or of all, are asked for, and {kept} kept. Older ones are in the gateway's database.</source>
            <translation>El registre no va més enrere: es demanen les {asked} ordres més noves de cada robot triat, o de tots, i se'n guarden {kept}. Les més antigues són a la base de dades de la passarel·la.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Which commands are listed</source>
            <translation>Quines ordres es llisten</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Whose commands are listed</source>
            <translation>De qui són les ordres llistades</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Write what is listed, every step of it, as CSV</source>
            <translation>Escriu el que es llista, amb tots els passos, com a CSV</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>{commands} and {steps} written to {path}</source>
            <translation>s'han escrit {commands} i {steps} a {path}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>{what} of {robot} leads to no place.</source>
            <translation>{what} de {robot} no porta a cap lloc.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>Details</source>
            <translation>Detalls</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>{metres:.2f} m off</source>
            <translation>{metres:.2f} m de desviació</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>{number} open: {counts}</source>
            <translation>{number} obertes: {counts}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>&amp;Coordinates</source>
            <translation>&amp;Coordenades</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>A coordinate of what is selected is no number. Correct it, or leave it out.</source>
            <translation>Una coordenada del seleccionat no és un nombre. Corregiu-la o ometeu-la.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>A route is one line, and {features} of the layer {layer} are meant: select one.</source>
            <translation>Una ruta és una línia, i n'hi ha {features} de la capa {layer}: seleccioneu-ne una.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>C&amp;RS</source>
            <translation>S&amp;RC</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Coordinates</source>
            <translation>Coordenades</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Feature {id} of {layer} has no place in the site's CRS ({error}). Leave it out, or correct the layer's CRS.</source>
            <translation>L'entitat {id} de {layer} no té lloc al SRC del recinte ({error}). Ometeu-la, o corregiu el SRC de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>No layer of points or lines is active. Click one in the Layers panel, then try again.</source>
            <translation>No hi ha cap capa de punts o línies activa. Feu clic en una al tauler Capes i torneu-ho a provar.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>No robot is selected. Select the one that the draft is for, then try again.</source>
            <translation>No hi ha cap robot seleccionat. Seleccioneu aquell per a qui és l'esborrany i torneu-ho a provar.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Set on the map</source>
            <translation>Posa al mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has no CRS, so nobody knows where its points are. Set it in the layer's properties.</source>
            <translation>La capa {layer} no té SRC, així que ningú sap on són els seus punts. Definiu-lo a les propietats de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has no feature with a place to go to.</source>
            <translation>La capa {layer} no té cap entitat amb un lloc on anar.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has not answered for {seconds:g} s, so no draft was made of it. Bring its server or drive back and try again.</source>
            <translation>La capa {layer} no respon des de fa {seconds:g} s, així que no se n'ha fet cap esborrany. Restabliu-ne el servidor o la unitat i torneu-ho a provar.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has {count} features and a queue takes {longest_queue}: select those that are meant.</source>
            <translation>La capa {layer} té {count} entitats i una cua n'admet {longest_queue}: seleccioneu les que voleu.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has {places} points selected and a queue takes {longest_queue}: select fewer.</source>
            <translation>La capa {layer} té {places} punts seleccionats i una cua n'admet {longest_queue}: seleccioneu-ne menys.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} holds polygons: take a layer of points (targets) or lines (a route).</source>
            <translation>La capa {layer} conté polígons: agafeu una capa de punts (objectius) o línies (una ruta).</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The line has {places} vertices; a route takes 2 to {longest_path}: simplify it first.</source>
            <translation>La línia té {places} vèrtexs; una ruta n'admet de 2 a {longest_path}: simplifiqueu-la abans.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The line that is selected in {layer} has {parts} parts, and a robot cannot leap from one to the next: make it one line.</source>
            <translation>La línia seleccionada a {layer} té {parts} parts, i un robot no pot saltar d'una a l'altra: feu-ne una sola línia.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Write {order} in {crs}.
{path}</source>
            <translation>Escriviu {order} en {crs}.
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
            <translation>{x:.2f}, {y:.2f} m al recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Choose a conflict in the list first.</source>
            <translation>Trieu primer un conflicte de la llista.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Give way</source>
            <translation>Cedeix el pas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>No robot is in another one's way.</source>
            <translation>Cap robot no és al pas d'un altre.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Nobody can be sent aside: {why}</source>
            <translation>No es pot enviar ningú a un costat: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Send aside</source>
            <translation>Aparta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Send {robot} aside</source>
            <translation>Aparta {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Stop</source>
            <translation>Aturar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Stop {robot}</source>
            <translation>Atura {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>at {x:.0f}, {y:.0f} m</source>
            <translation>a {x:.0f}, {y:.0f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>the gateway is being asked</source>
            <translation>s'està preguntant a la passarel·la</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>the gateway's answer cannot be read; it may be older than this plugin</source>
            <translation>la resposta de la passarel·la no es pot llegir; potser és més antiga que aquest connector</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} gives way</source>
            <translation>{robot} cedeix el pas</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} is paused: it stands, and keeps what it is doing for later</source>
            <translation>{robot} es posa en pausa: s'atura i guarda per a més tard el que fa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} waits for {other} or takes another way, whichever gets it there sooner</source>
            <translation>{robot} espera {other} o agafa un altre recorregut, el que hi arribi abans</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} waits for {other}, until {time_of_day} at the earliest</source>
            <translation>{robot} espera {other}, com a mínim fins a les {time_of_day}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} × {other}: over</source>
            <translation>{robot} × {other}: acabat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{text}; the route is shown first, and sent as any other</source>
            <translation>{text}; primer es mostra la ruta, i s'envia com qualsevol altra</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Gateway</source>
            <translation>&amp;Passarel·la</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Keep under a name…</source>
            <translation>&amp;Desa amb un nom…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Manage connections…</source>
            <translation>&amp;Gestiona les connexions…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Access…</source>
            <translation>Accés…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>CA file</source>
            <translation>Fitxer de CA</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Certificates (*.pem *.crt *.cer);;All files (*)</source>
            <translation>Certificats (*.pem *.crt *.cer);;Tots els fitxers (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connect</source>
            <translation>Connecta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connected</source>
            <translation>Connectat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connecting</source>
            <translation>Connectant</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connection: {name}</source>
            <translation>Connexió: {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connections that are kept under a name</source>
            <translation>Connexions que es guarden amb un nom</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Disconnect</source>
            <translation>Desconnecta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Encrypted, under the master password of the QGIS authentication manager</source>
            <translation>Xifrat, amb la contrasenya mestra del gestor d'autenticació de QGIS</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Failed</source>
            <translation>Fallit</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Keep in QGIS</source>
            <translation>Desa a QGIS</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Not connected</source>
            <translation>No connectat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Retrying</source>
            <translation>Tornant-ho a provar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Retrying in {wait:.0f} s</source>
            <translation>Es torna a provar d'aquí {wait:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>The site's ca.pem</source>
            <translation>El ca.pem del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Token and CA file, for a gateway with accounts and TLS</source>
            <translation>Testimoni i fitxer de CA, per a una passarel·la amb comptes i TLS</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Who you are: it stands beside every command in every log</source>
            <translation>Qui sou: és al costat de cada ordre a tots els registres</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>fleet_op_…, as it was printed when the account was made</source>
            <translation>fleet_op_…, tal com es va escriure en crear el compte</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>kept by QGIS; enter another one to replace it</source>
            <translation>el guarda QGIS; introduïu-ne un altre per canviar-lo</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>of the connection's authentication; enter another one for this time</source>
            <translation>de l'autenticació de la connexió; introduïu-ne un altre per aquesta vegada</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>the site's ca.pem; empty for public authorities</source>
            <translation>el ca.pem del recinte; buit per a autoritats públiques</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/dock.py" />
            <source>Queue</source>
            <translation>Cua</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source> since {time}</source>
            <translation> des de les {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Clear the emergency stop?</source>
            <translation>Voleu aixecar la parada d'emergència?</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Cleared, robots can be sent again. None sets off by itself: what they were doing was aborted.</source>
            <translation>Aixecada, es poden tornar a enviar robots. Cap arrenca sol: el que feien s'ha avortat.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Clear…</source>
            <translation>Aixeca…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>EMERGENCY STOP asked for. The gateway has not confirmed it yet: watch the robots, and use their own emergency stops.</source>
            <translation>PARADA D'EMERGÈNCIA demanada. La passarel·la encara no l'ha confirmada: vigileu els robots i feu servir les seves parades d'emergència.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>EMERGENCY STOP in force{since}, by {by}{reason}</source>
            <translation>PARADA D'EMERGÈNCIA en vigor{since}, per {by}{reason}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>In force at {reached} of {of} gateways</source>
            <translation>En vigor a {reached} de {of} passarel·les</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Keep it in force</source>
            <translation>Mantén-la en vigor</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>MOVING: {names}</source>
            <translation>ES MOUEN: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>NOT REACHED: gateways {names}. Watch their robots</source>
            <translation>NO S'HA ARRIBAT a les passarel·les {names}. Vigileu els seus robots</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>No answer from {names}</source>
            <translation>Sense resposta de {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Not heard now, may move: {names}</source>
            <translation>Ara no se'n sap res, es poden moure: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Not stored yet: the gateway cannot write its database, so robots on SQL are not told.</source>
            <translation>Encara no s'ha desat: la passarel·la no pot escriure la base de dades, així que els robots per SQL no se n'assabenten.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>REFUSED by {names}</source>
            <translation>REBUTJADA per {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>The gateway has said nothing for {seconds} s: robots may move. It said last:</source>
            <translation>Fa {seconds} s que la passarel·la no diu res: els robots es poden moure. L'últim que ha dit:</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Why robots may drive again, for the log</source>
            <translation>Per què els robots poden tornar a circular, per al registre</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/emergency.py" />
            <source>{acknowledged} of %n robots acknowledged, {standing} seen to stand</source>
            <translation>
                <numerusform>{acknowledged} de %n robot ho ha confirmat, {standing} es veu aturat</numerusform>
                <numerusform>{acknowledged} de %n robots ho han confirmat, {standing} es veuen aturats</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source> Override… sends it all the same, where your role may.</source>
            <translation> Imposa… ho envia igualment, on el vostre paper ho permeti.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Map for {robot}</source>
            <translation>Mapa per a {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>No robot is selected, so none was sent the map. Select it first.</source>
            <translation>No hi ha cap robot seleccionat, així que no s'ha enviat el mapa a cap. Seleccioneu-lo abans.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Nothing is sent yet.</source>
            <translation>Encara no s'envia res.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Override</source>
            <translation>Imposa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Override the checks</source>
            <translation>Imposa's a les comprovacions</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Select a robot, choose Cone target or Draw route, and click on the map.</source>
            <translation>Seleccioneu un robot, trieu Objectiu de con o Dibuixa ruta, i feu clic al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>The draft has changed since it was looked at, so nothing was overridden. Press Override again.</source>
            <translation>L'esborrany ha canviat des que es va mirar, així que no s'ha imposat res. Torneu a prémer Imposa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>There is no draft on the map. Select a robot, then set a cone target or draw a route.</source>
            <translation>No hi ha cap esborrany al mapa. Seleccioneu un robot, i poseu un objectiu de con o dibuixeu una ruta.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Why it is right all the same</source>
            <translation>Per què és correcte tanmateix</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Your name, what was found and why go into the gateway's log.</source>
            <translation>El vostre nom, el que s'ha trobat i el perquè van al registre de la passarel·la.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>because: {reason}</source>
            <translation>perquè: {reason}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words} is being checked: {share:.0%}. It goes out when nothing speaks against it.</source>
            <translation>{in_words} s'està comprovant: {share:.0%}. Sortirà si res no hi parla en contra.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words} was not put into the queue: {fault}</source>
            <translation>{in_words} no s'ha posat a la cua: {fault}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}, into the queue</source>
            <translation>{in_words}, a la cua</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Being checked: {share:.0%}.</source>
            <translation>{in_words}. S'està comprovant: {share:.0%}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Being checked: {share:.0%}. It goes out when nothing speaks against it; Esc keeps it back.</source>
            <translation>{in_words}. S'està comprovant: {share:.0%}. S'enviarà si res no hi va en contra; Esc ho atura.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. It goes out when that is found and nothing speaks against it; Esc keeps it back.</source>
            <translation>{in_words}. S'enviarà quan s'hagi trobat el camí i si res no hi va en contra; Esc ho atura.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Not to be sent: {found}{hint}</source>
            <translation>{in_words}. No es pot enviar: {found}{hint}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. OVERRIDDEN: {override}. Enter or Send sends it.</source>
            <translation>{in_words}. IMPOSAT: {override}. Retorn o Envia ho envia.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}.{warnings} Add to queue lets them be placed one after the other.</source>
            <translation>{in_words}.{warnings} Afegeix a la cua fa que es col·loquin un rere l'altre.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}.{warnings} Enter or Send sends it.</source>
            <translation>{in_words}.{warnings} Retorn o Envia ho envia.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}: there is nothing here that an override would help.</source>
            <translation>{in_words}: aquí no hi ha res en què ajudi imposar-se.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>A task of {robot} first</source>
            <translation>Una tasca de {robot} primer</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Continue for {robot}</source>
            <translation>Continua per a {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Do now</source>
            <translation>Fes ara</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Let the robot do the selected task at once; what it is doing comes next (Ctrl+Enter)</source>
            <translation>Que el robot faci la tasca seleccionada de seguida; el que fa ve després (Ctrl+Retorn)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Let the robot go on with the task at the head of its queue</source>
            <translation>Deixa que el robot segueixi amb la primera tasca de la cua</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Move the selected task one down (Alt+Down)</source>
            <translation>Mou la tasca seleccionada un lloc avall (Alt+Avall)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Move the selected task one up (Alt+Up)</source>
            <translation>Mou la tasca seleccionada un lloc amunt (Alt+Amunt)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Moving a task of {robot}</source>
            <translation>Moure una tasca de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>No robot is selected, so none was paused. Select it in the table or on the map.</source>
            <translation>No hi ha cap robot seleccionat, així que no se n'ha posat cap en pausa. Seleccioneu-lo a la taula o al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Not done: the queue has changed since you saw it. This is how it stands now.</source>
            <translation>No s'ha fet: la cua ha canviat des que l'heu vista. Ara està així.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Pause</source>
            <translation>Pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Pausing the queue of {robot}</source>
            <translation>Posar en pausa la cua de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Removing a task of {robot}</source>
            <translation>Treure una tasca de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Resume</source>
            <translation>Reprèn</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Resuming the queue of {robot}</source>
            <translation>Reprendre la cua de {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Select a robot to see its queue. None has one yet.</source>
            <translation>Seleccioneu un robot per veure la seva cua. Encara no en té cap.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Select a robot to see its queue. {queues} have one, {paused} of them paused.</source>
            <translation>Seleccioneu un robot per veure la seva cua. {queues} en tenen, {paused} en pausa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Send the robot no further task; what it is doing it finishes (Pause robot stops it)</source>
            <translation>No enviïs més tasques al robot; acaba el que està fent (Posa robot en pausa l'atura)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Take the selected task out (Delete)</source>
            <translation>Treu la tasca seleccionada (Supr)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Task</source>
            <translation>Tasca</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The gateway has not answered yet what was asked of the queue of {robot} before. Try again in a moment.</source>
            <translation>La passarel·la encara no ha respost el que es va demanar abans de la cua de {robot}. Torneu-ho a provar d'aquí un moment.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The link was lost before the answer, and the queue has changed, perhaps by this. So it stands now.</source>
            <translation>L'enllaç s'ha perdut abans de la resposta, i la cua ha canviat, potser per això. Ara està així.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The queue of {robot} was paused just before the click, so it was not resumed. Press Resume again to let it continue.</source>
            <translation>La cua de {robot} s'ha posat en pausa just abans del clic, de manera que no s'ha reprès. Premeu Reprèn un altre cop perquè continuï.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>added by {by}</source>
            <translation>afegida per {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>waiting: robot</source>
            <translation>en espera: robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{robot} continues</source>
            <translation>{robot} continua</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{robot} continues with {task}</source>
            <translation>{robot} continua amb {task}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{selected} has no queue. Add a target or a route with Add to queue.</source>
            <translation>{selected} no té cua. Afegiu un objectiu o una ruta amb Afegeix a la cua.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>, {metres:.2f} m off</source>
            <translation>, {metres:.2f} m de desviació</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Ask again</source>
            <translation>Torna a demanar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Ask for the robot's last image and its commands again</source>
            <translation>Torna a demanar l'última imatge i les ordres del robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Diagnostics as received</source>
            <translation>Diagnòstic tal com ha arribat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>It says</source>
            <translation>Diu</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>No image: {why}</source>
            <translation>Cap imatge: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Now</source>
            <translation>Ara</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Off path or target</source>
            <translation>Desviació del camí o l'objectiu</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Position, {crs}</source>
            <translation>Posició, {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Reading a robot's image</source>
            <translation>S'està llegint la imatge d'un robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Select a robot in the table or on the map</source>
            <translation>Seleccioneu un robot a la taula o al mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>The image that came cannot be read: it is none of a kind that QGIS knows.</source>
            <translation>La imatge que ha arribat no es pot llegir: no és de cap tipus que QGIS conegui.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Why elsewhere</source>
            <translation>Per què en un altre lloc</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>and {more} more</source>
            <translation>i {more} més</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>looking for an image …</source>
            <translation>s'està buscant una imatge …</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>the image is coming …</source>
            <translation>arriba la imatge …</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{command}, by {operator}</source>
            <translation>{command}, per {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{robot} has sent no image lately</source>
            <translation>{robot} no ha enviat cap imatge darrerament</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{robot}, selected last of several</source>
            <translation>{robot}, l'últim seleccionat de diversos</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Age</source>
            <translation>Edat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Batt.</source>
            <translation>Bat.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How far it is beside its path, or from the target that it reached last</source>
            <translation>A quina distància és del seu camí, o de l'últim objectiu assolit</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How far what is known of it can be trusted</source>
            <translation>Fins a quin punt es pot confiar en el que se'n sap</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How full its battery is</source>
            <translation>Com de plena té la bateria</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How it is connected; @ and a name: at another gateway</source>
            <translation>Com està connectat; @ i un nom: en una altra passarel·la</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How long ago anything was heard of it</source>
            <translation>Quant fa que se'n va saber alguna cosa</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How long its link takes there and back</source>
            <translation>Quant triga el seu enllaç anar i tornar</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Its speed, as it says</source>
            <translation>La seva velocitat, tal com diu</translation>
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
            <translation>Posició</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Speed</source>
            <translation>Velocitat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>The robot's name</source>
            <translation>El nom del robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>What it is doing, or what it says</source>
            <translation>Què fa, o què diu</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Where it is, in the CRS chosen under Columns</source>
            <translation>On és, en el SRC triat a Columnes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>at {x:.2f}, {y:.2f} m in the site frame</source>
            <translation>a {x:.2f}, {y:.2f} m en el marc del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>cone</source>
            <translation>con</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>it says: {text}</source>
            <translation>diu: {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>its link takes {ms:.1f} ms there and back</source>
            <translation>el seu enllaç triga {ms:.1f} ms anar i tornar</translation>
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
            <translation>aturat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>target</source>
            <translation>objectiu</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>to cone</source>
            <translation>al con</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>to target</source>
            <translation>a l'objectiu</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Another CRS…</source>
            <translation>Un altre SRC…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>CRS of the project ({crs})</source>
            <translation>SRC del projecte ({crs})</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Columns</source>
            <translation>Columnes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Latitude, longitude (WGS 84)</source>
            <translation>Latitud, longitud (WGS 84)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Name, state, task or link; several words have to be there all</source>
            <translation>Nom, estat, tasca o enllaç; si hi ha diverses paraules hi han de ser totes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Positions in: {crs}</source>
            <translation>Posicions en: {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Search</source>
            <translation>Cerca</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Search robots</source>
            <translation>Cerca robots</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Site frame (metres)</source>
            <translation>Marc del recinte (metres)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>The search finds others by name.</source>
            <translation>La cerca troba els altres pel nom.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Which columns are shown, and in which CRS positions are</source>
            <translation>Quines columnes es mostren, i en quin SRC són les posicions</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>With a task</source>
            <translation>Amb tasca</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>With alarms, or not fresh</source>
            <translation>Amb alarmes, o no frescos</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Without a task</source>
            <translation>Sense tasca</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>no such place</source>
            <translation>cap lloc així</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>{listed} of {all}</source>
            <translation>{listed} de {all}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source> Without a role, since other layers of the project have it: {layers}. Plugins &gt; Fleet Supervisor &gt; Layer roles changes that.</source>
            <translation> Sense paper, perquè el tenen altres capes del projecte: {layers}. Connectors &gt; Fleet Supervisor &gt; Papers de les capes ho canvia.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Closed before the gateway answered, so it may be done or not: {asked}</source>
            <translation>S'ha tancat abans que la passarel·la respongués, i per tant pot estar fet o no: {asked}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>No emergency stop is in force.</source>
            <translation>No hi ha cap parada d'emergència en vigor.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Quit all the same</source>
            <translation>Surt igualment</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Quit before the gateway has answered?</source>
            <translation>Voleu sortir abans que la passarel·la respongui?</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Stay</source>
            <translation>Queda't</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Targets and routes</source>
            <translation>Objectius i rutes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>The gateway has not answered yet: {asked}. Who quits now does not learn whether it is done, and what is not sent yet never is.</source>
            <translation>La passarel·la encara no ha respost: {asked}. Qui surt ara no sabrà si es fa, i el que encara no s'ha enviat no s'enviarà mai.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>The site in {folder} is in the project already: {names}.</source>
            <translation>El recinte de {folder} ja és al projecte: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>This project is not that of site {site}: its variables have another origin, CRS or rotation. Checks and alarms go by the layers of this project: open the site's.</source>
            <translation>Aquest projecte no és el del recinte {site}: les seves variables tenen un altre origen, SRC o rotació. Les comprovacions i les alarmes segueixen les capes d’aquest projecte: obriu el del recinte.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/window.py" />
            <source>{site}: %n layers loaded.</source>
            <translation>
                <numerusform>{site}: %n capa carregada.</numerusform>
                <numerusform>{site}: %n capes carregades.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>%n cones</source>
            <translation>
                <numerusform>%n con</numerusform>
                <numerusform>%n cons</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>%n cones placed</source>
            <translation>
                <numerusform>%n con col·locat</numerusform>
                <numerusform>%n cons col·locats</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>, {collected} collected again</source>
            <translation>, {collected} recollits de nou</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>As-placed report</source>
            <translation>Informe de col·locació</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Collected</source>
            <translation>Recollit</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Cone</source>
            <translation>Con</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Figures, histogram, map and table of these cones as a PDF</source>
            <translation>Xifres, histograma, mapa i taula d'aquests cons en un PDF</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>No cone was put down yet.</source>
            <translation>Encara no s'ha deixat cap con.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Off [m]</source>
            <translation>Desviació [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Placed</source>
            <translation>Col·locat</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Plan collecting</source>
            <translation>Planifica la recollida</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Planned x, y</source>
            <translation>x, y previstes</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Refresh</source>
            <translation>Actualitza</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Report…</source>
            <translation>Informe…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Save as CSV…</source>
            <translation>Desa com a CSV…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Stands at x, y</source>
            <translation>És a x, y</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>The report is made by QGIS's Processing: switch that on in Plugins &gt; Manage and Install Plugins.</source>
            <translation>L'informe el fa Processament de QGIS: activeu-lo a Connectors &gt; Gestiona i instal·la els connectors.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>everything</source>
            <translation>tot</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>layout {name}</source>
            <translation>disposició {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>off by {mean:.3f} m on average, at most {largest:.3f} m</source>
            <translation>desviació mitjana de {mean:.3f} m, com a màxim {largest:.3f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>the plan that is driven</source>
            <translation>el pla que s'executa</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{cones} of %n cones placed</source>
            <translation>
                <numerusform>{cones} de %n con col·locat</numerusform>
                <numerusform>{cones} de %n cons col·locats</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{cones} written to {path}</source>
            <translation>s'ha escrit a {path}: {cones}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{placed}{gone}; {off}</source>
            <translation>{placed}{gone}; {off}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>A new plan was sent by itself, as was switched on: {why}</source>
            <translation>S'ha enviat un pla nou tot sol, tal com estava activat: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>A plan is being driven. Plan what is left, choose New plan to plan for other robots, or press Clear: nobody follows it then, and robots go on with their queues.</source>
            <translation>S'està executant un pla. Planifiqueu el que queda, trieu Pla nou per planificar per a altres robots, o premeu Neteja: llavors ningú no el segueix i els robots continuen amb les seves cues.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Clearing the cone plan</source>
            <translation>Esborrat del pla de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Going on as before</source>
            <translation>Continuació com abans</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Going on with the cone plan</source>
            <translation>Continuació del pla de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>No new cone plan was sent by itself: {why}.</source>
            <translation>No s'ha enviat tot sol cap pla de cons nou: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>No plan is being driven, or something is still being sent.</source>
            <translation>No s'executa cap pla, o encara s'està enviant alguna cosa.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Nothing was overridden: what was refused is no longer being sent. Look at the plan.</source>
            <translation>No s'ha imposat res: el que es va rebutjar ja no s'està enviant. Mireu el pla.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Pause of the cone plan</source>
            <translation>Pausa del pla de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Paused: {robots} ({why})</source>
            <translation>En pausa: {robots} ({why})</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Plan of what is left</source>
            <translation>Pla del que queda</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Sending the cone plan</source>
            <translation>Enviament del pla de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan cannot go on as it is: {why}. Plan what is left.</source>
            <translation>El pla de cons no pot seguir com és: {why}. Planifiqueu el que queda.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan is in the robots' queues.</source>
            <translation>El pla de cons és a les cues dels robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan is paused: {why}.</source>
            <translation>El pla de cons està en pausa: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan was not sent. {words}: {found} Override… in the panel Cone plan sends it all the same, where your role may.</source>
            <translation>El pla de cons no s'ha enviat. {words}: {found} Imposa… al tauler Pla de cons ho envia igualment, on el vostre paper ho permeti.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The gateway is older than this plugin and drives no cone plans: plans are made and looked at here, and nothing of them is sent. Update the gateway, or give robots their cones with Add to queue.</source>
            <translation>La passarel·la és més antiga que aquest connector i no executa plans de cons: aquí es fan i es miren plans, i no se n'envia res. Actualitzeu la passarel·la, o doneu els cons als robots amb Afegeix a la cua.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The new cone plan</source>
            <translation>El pla de cons nou</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The plan cannot be sent: {error}</source>
            <translation>El pla no es pot enviar: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>There is no new plan to confirm.</source>
            <translation>No hi ha cap pla nou a confirmar.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>There is no plan to send. Make one with Preview or Solve first.</source>
            <translation>No hi ha cap pla a enviar. Feu-ne un abans amb Vista prèvia o Resol.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>{by} cleared the cone plan: nobody follows it any more, and robots go on with their queues.</source>
            <translation>{by} ha esborrat el pla de cons: ja ningú no el segueix, i els robots continuen amb les seves cues.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>A cone takes</source>
            <translation>Un con triga</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Aboard</source>
            <translation>A bord</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Aboard: cones on the robot now. Range: metres of battery, 0 if it does not matter</source>
            <translation>A bord: cons al robot ara. Abast: metres de bateria, 0 si no importa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>At the end</source>
            <translation>Al final</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Carries</source>
            <translation>Porta</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Cones</source>
            <translation>Cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>How it is planned</source>
            <translation>Com es planifica</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Least</source>
            <translation>Mínim</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Off cones by</source>
            <translation>Lluny de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Off robots by</source>
            <translation>Lluny de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Only the features of the layer that are selected</source>
            <translation>Només les entitats seleccionades de la capa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Range</source>
            <translation>Abast</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Robots that come nearer to one another by the plan are named</source>
            <translation>S'anomenen els robots que segons el pla s'acosten més</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Solve for at most</source>
            <translation>Resol com a màxim en</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Stores</source>
            <translation>Magatzems</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Straight within</source>
            <translation>Recte dins de</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>The layers of the project with the role road centreline</source>
            <translation>Les capes del projecte amb el paper eix de via</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Ways are led round cones by so much</source>
            <translation>Els recorreguts volten els cons a aquesta distància</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>along the roads of the project</source>
            <translation>per les vies del projecte</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>choose a layer of points</source>
            <translation>trieu una capa de punts</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>m/s</source>
            <translation>m/s</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>selected</source>
            <translation>seleccionats</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>{column} of {robot} is {text!r}: give {least:g} or more.</source>
            <translation>{column} de {robot} és {text!r}: doneu {least:g} o més.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>{name} is away: it takes no part</source>
            <translation>{name} no hi és: no hi participa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Degrees clockwise from north; the wheel over the map turns it too</source>
            <translation>Graus en sentit horari des del nord; la roda sobre el mapa també la gira</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Heading</source>
            <translation>Rumb</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Remove the cones that were placed last; Ctrl+Z over the map does so too</source>
            <translation>Treu els cons col·locats en darrer lloc; Ctrl+Z sobre el mapa també ho fa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Reset to the standard</source>
            <translation>Restableix la norma</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Standard: {value}</source>
            <translation>Norma: {value}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Take back the last layout</source>
            <translation>Retira la darrera disposició</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>too many cones; a plan has {most} at most</source>
            <translation>massa cons; un pla en té {most} com a màxim</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The cones of the layer {layer} are not saved with the project: {problem}. Export the layer to a file before you close QGIS.</source>
            <translation>Els cons de la capa {layer} no s'han desat amb el projecte: {problem}. Exporteu la capa a un fitxer abans de tancar QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer of cones is another one now: place the layout again.</source>
            <translation>La capa de cons ara és una altra: torneu a col·locar la disposició.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer {layer} takes no cones without the fields {fields}: add them, or remove the layer.</source>
            <translation>La capa {layer} no admet cons sense els camps {fields}: afegiu-los, o traieu la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer {layer} takes no cones: make it writable, or remove it.</source>
            <translation>La capa {layer} no admet cons: feu-la editable, o traieu-la.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The project has no CRS: choose one in metres, at the bottom right in QGIS.</source>
            <translation>El projecte no té SRC: trieu-ne un en metres, a baix a la dreta de QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>the project is not a file</source>
            <translation>el projecte no és un fitxer</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>{path} cannot be read again</source>
            <translation>{path} no es pot tornar a llegir</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>{path} cannot be written ({words})</source>
            <translation>{path} no es pot escriure ({words})</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>%n cones are in the layer {layer}.</source>
            <translation>
                <numerusform>%n con és a la capa {layer}.</numerusform>
                <numerusform>%n cons són a la capa {layer}.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>Place a cone layout: it is shown under the cursor, the wheel turns it, with Shift finely, a click places it, Ctrl+Z takes it back, Esc ends; by keys PgUp and PgDown turn it, Enter places it, F2 leads to its dimensions. Nothing is sent to robots</source>
            <translation>Col·loca una disposició de cons: es mostra sota el cursor, la roda la gira, amb Maj finament, un clic la col·loca, Ctrl+Z la retira, Esc acaba; amb tecles, RePàg i AvPàg la giren, Retorn la col·loca, F2 porta a les dimensions. No s'envia res als robots</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>Place cone layout</source>
            <translation>Col·loca una disposició de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>The cones in the layer {layer} were not checked: {why}</source>
            <translation>Els cons de la capa {layer} no s'han comprovat: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>layers of road surfaces and obstacles have not been read within {seconds:g} s</source>
            <translation>les capes de superfícies de via i d'obstacles no s'han llegit en {seconds:g} s</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>{wrong} of %n cones should not stand there: {text} All are in the layer {layer}.</source>
            <translation>
                <numerusform>{wrong} de %n con no hauria de ser allà: {text} És a la capa {layer}.</numerusform>
                <numerusform>{wrong} de %n cons no haurien de ser allà: {text} Tots són a la capa {layer}.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>%n ways lead along closed roads</source>
            <translation>
                <numerusform>%n camí passa per vies tancades</numerusform>
                <numerusform>%n camins passen per vies tancades</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A good plan, within the time that is given</source>
            <translation>Un bon pla, dins del temps donat</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A new plan, or one that the gateway drives, whoever submitted it</source>
            <translation>Un pla nou, o un que executa la passarel·la, sigui qui sigui qui l'ha enviat</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A quick plan, to look at</source>
            <translation>Un pla ràpid, per mirar-lo</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>As placed</source>
            <translation>Com s'ha col·locat</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Being sent …</source>
            <translation>S'està enviant …</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Clear</source>
            <translation>Neteja</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Cone plan</source>
            <translation>Pla de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Confirm new plan</source>
            <translation>Confirma el pla nou</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Do not send</source>
            <translation>No l'enviïs</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Done: {done} of %n cones</source>
            <translation>
                <numerusform>Fet: {done} de %n con</numerusform>
                <numerusform>Fet: {done} de %n cons</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Follow the plan no more, at no desk; robots go on with their queues</source>
            <translation>Deixa de seguir el pla a totes les consoles; els robots continuen amb les seves cues</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Give up what is being planned</source>
            <translation>Abandona el que s'està planificant</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Go on as before</source>
            <translation>Segueix com abans</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Hold the robots once they have finished what they are doing, and plan what is left; nothing else is sent before you confirm</source>
            <translation>Reté els robots quan acaben el que fan, i planifica el que queda; no s'envia res més fins que ho confirmeu</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Let them go on</source>
            <translation>Que continuïn</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>New plan</source>
            <translation>Pla nou</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>New plan, not sent yet: {summary}</source>
            <translation>Pla nou, encara no enviat: {summary}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>No plan. Choose cones and robots, then Preview or Solve.</source>
            <translation>Cap pla. Trieu cons i robots, i després Vista prèvia o Resol.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Not sent yet: {summary}</source>
            <translation>Encara no enviat: {summary}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Override…</source>
            <translation>Imposa…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Pause the plan</source>
            <translation>Pausa el pla</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Placed cones</source>
            <translation>Cons col·locats</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan</source>
            <translation>Pla</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan what is left</source>
            <translation>Planifica el que queda</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan which robot places or collects which cone, send it, watch it; the as-placed report</source>
            <translation>Planifica quin robot col·loca o recull quin con, ho envia i ho segueix; l'informe de col·locació</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Preview</source>
            <translation>Vista prèvia</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Resume the queues of the plan's robots that somebody paused</source>
            <translation>Reprèn les cues dels robots del pla que algú ha posat en pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send</source>
            <translation>Envia</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send new plans without asking</source>
            <translation>Envia plans nous sense preguntar</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the cone plan</source>
            <translation>Envia el pla de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the plan in spite of what was found; asks why</source>
            <translation>Envia el pla malgrat el que s'ha trobat; en demana el motiu</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the plan's robots no further task; what they are doing they finish</source>
            <translation>No s'envia cap més tasca als robots del pla; acaben el que estan fent</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send…</source>
            <translation>Envia…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Solve</source>
            <translation>Resol</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>The plan is sent at once, and robots set off.</source>
            <translation>El pla s'envia de seguida, i els robots es posen en marxa.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Under way: {done} of %n cones</source>
            <translation>
                <numerusform>En curs: {done} de %n con</numerusform>
                <numerusform>En curs: {done} de %n cons</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>What is left is being planned …</source>
            <translation>S'està planificant el que queda …</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>When a robot is lost or a cone fails, plan what is left and send it by itself</source>
            <translation>Quan es perd un robot o falla un con, planifica el que queda i ho envia sol</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>robots come too near to one another at %n places</source>
            <translation>
                <numerusform>els robots s'acosten massa entre ells en %n lloc</numerusform>
                <numerusform>els robots s'acosten massa entre ells en %n llocs</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>try failed cones again</source>
            <translation>torna a provar els cons fallits</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>; {queued} are in queues already</source>
            <translation>; {queued} ja són en cues</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>A plan is being made. Wait for it, or press Cancel.</source>
            <translation>S'està fent un pla. Espereu-lo, o premeu Cancel·la.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Change of the cone plan</source>
            <translation>Canvi del pla de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Collecting cannot be planned: {error}</source>
            <translation>No es pot planificar la recollida: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone of layout {layout} stands that could be collected{also}.</source>
            <translation>No hi ha cap con de la disposició {layout} que es pugui recollir{also}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone of this plan stands that could be collected: none was placed, or they are collected or in queues already. For others choose a layout, or everything.</source>
            <translation>No hi ha cap con d'aquest pla dret que es pugui recollir: no se n'ha col·locat cap, o ja s'han recollit o són en cues. Per als altres trieu una disposició, o tot.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone stands that could be collected{also}.</source>
            <translation>No hi ha cap con que es pugui recollir{also}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No robot that is there is chosen: tick robots in the table, or connect some.</source>
            <translation>No s'ha triat cap robot present: marqueu robots a la taula, o connecteu-ne.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Others take no part in the plan.</source>
            <translation>Els altres no participen en el pla.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Preview of the cone plan</source>
            <translation>Vista prèvia del pla de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>There is no store where robots load or unload cones: choose a layer of points under Stores, or write under Aboard how many cones each robot has to place.</source>
            <translation>No hi ha cap magatzem on els robots carreguin o descarreguin cons: trieu una capa de punts a Magatzems, o escriviu a A bord quants cons per col·locar porta cada robot.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>What is to be collected</source>
            <translation>Què cal recollir</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>No layer of cones is chosen. Choose one, or place a cone layout first.</source>
            <translation>No s'ha triat cap capa de cons. Trieu-ne una, o col·loqueu abans una disposició de cons.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>The layer of stores is not in the project any more. Choose another, or none.</source>
            <translation>La capa de magatzems ja no és al projecte. Trieu-ne una altra, o cap.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>The layer {layer} has {which}: there is nothing to be placed.</source>
            <translation>La capa {layer} té {which}: no hi ha res a col·locar.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>no features</source>
            <translation>cap entitat</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>no selected features</source>
            <translation>cap entitat seleccionada</translation>
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
                <numerusform>se substitueix %n tasca que espera a la cua de {id}</numerusform>
                <numerusform>se substitueixen %n tasques que esperen a la cua de {id}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>FAILED</source>
            <translation>HA FALLAT</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>Found by: {method}. Ways along: {travel}.</source>
            <translation>Mètode: {method}. Els camins segueixen: {travel}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>Mind:</source>
            <translation>Atenció:</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>The queue of {robot} stays paused ({reason}): its cones wait until it is resumed.</source>
            <translation>La cua de {robot} segueix en pausa ({reason}): els seus cons esperen que es reprengui.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>The robots set off at once.</source>
            <translation>Els robots arrenquen de seguida.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>cone {cone} failed{why}</source>
            <translation>el con {cone} ha fallat{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>in the queue</source>
            <translation>a la cua</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>it is not known where {id} is</source>
            <translation>no se sap on és {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>no reason</source>
            <translation>cap motiu</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>straight lines</source>
            <translation>línies rectes</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>taken out</source>
            <translation>tret</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the queue of {id} is paused ({reason}): it is resumed</source>
            <translation>la cua de {id} és en pausa ({reason}): es reprèn</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the roads</source>
            <translation>les vies</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the way of {robot} to {stop} leads along a closed road{why}</source>
            <translation>el camí de {robot} a {stop} passa per una via tancada{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>under way</source>
            <translation>en curs</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{by}, {time}: {robots}</source>
            <translation>{by}, {time}: {robots}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{cones}, {robots}, {metres:.0f} m, done after {span} ({method}, along {travel})</source>
            <translation>{cones}, {robots}, {metres:.0f} m, fet en {span} ({method}, per {travel})</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} finishes first what it is doing</source>
            <translation>{id} acaba abans el que fa</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} is {away:.1f} m from where the plan begins: better plan anew</source>
            <translation>{id} és a {away:.1f} m d'on comença el pla: millor tornar a planificar</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} is {state}: it gets its queue when it is heard of again</source>
            <translation>{id} és {state}: rep la cua quan se'n torni a saber</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{robot} is lost or offline</source>
            <translation>{robot} és perdut o fora de línia</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{text}. Left out: {names}</source>
            <translation>{text}. Fora: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Arrives</source>
            <translation>Arriba</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cone plan, stops</source>
            <translation>Pla de cons, parades</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cone plan, ways</source>
            <translation>Pla de cons, recorreguts</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cones as placed</source>
            <translation>Cons tal com s'han col·locat</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Drag a cone to another place or robot; Alt+Up and Alt+Down move it, Del takes it out</source>
            <translation>Arrossegueu un con a un altre lloc o robot; Alt+Amunt i Alt+Avall el mouen, Supr el treu</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Give to {name}</source>
            <translation>Dona a {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>LOST, {text}</source>
            <translation>PERDUT, {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Robot, stop</source>
            <translation>Robot, parada</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Take out</source>
            <translation>Treu</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>collect </source>
            <translation>recollir </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>end at </source>
            <translation>final a </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>store </source>
            <translation>magatzem </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_views.py" />
            <source>{done} of %n cones</source>
            <translation>
                <numerusform>{done} de %n con</numerusform>
                <numerusform>{done} de %n cons</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>The assignment was cancelled.</source>
            <translation>S'ha cancel·lat l'assignació.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>The plan could not be made. Please report this:
{traceback}</source>
            <translation>El pla no s'ha pogut fer. Comuniqueu això:
{traceback}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>the way of {robot} to {stop} leads along a road that {by} closed{why}</source>
            <translation>el camí de {robot} a {stop} passa per una via que {by} ha tancat{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>{name}, straight within {nearby:g} m</source>
            <translation>{name}, recte dins de {nearby:g} m</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>{robot} and {other} come within {metres:.1f} m at {x:.0f}, {y:.0f} m after {minutes}:{seconds:02d}</source>
            <translation>{robot} i {other} s'acosten a {metres:.1f} m a {x:.0f}, {y:.0f} m al cap de {minutes}:{seconds:02d}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>%n features have no planned or no placed position; they are left out.</source>
            <translation>
                <numerusform>%n entitat no té posició planificada o col·locada; queda fora.</numerusform>
                <numerusform>%n entitats no tenen posició planificada o col·locada; queden fora.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>95 % deviate at most [m]</source>
            <translation>El 95 % es desvia com a màxim [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>&lt;p&gt;Compares where cones stand with where they were to stand, and writes a PDF: how many are within the tolerance, a histogram of the deviations, a map and a table of every cone, worst first.&lt;/p&gt; &lt;p&gt;The cones are a layer of the GeoPackage that &lt;i&gt;robot-bridge placements export cones.gpkg --site site&lt;/i&gt; writes, or its CSV; for a CSV, which has none, give the site's CRS. A cone stands where the robot was when it had reached its target, and from there the site's cone offset: the gateway's knowledge, no survey.&lt;/p&gt; &lt;p&gt;On the map a cross is the plan and a circle the cone, red where it is beyond the tolerance. Deviations are small: the lines from the crosses are longer than they are by the factor that the map names. Give background layers, such as roads, to be drawn beneath.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:asplacedreport -- INPUT="cones.gpkg|layername=placed" TOLERANCE=0.2 OUTPUT=report.pdf&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Compara on són els cons amb on havien de ser, i escriu un PDF: quants són dins de la tolerància, un histograma de les desviacions, un mapa i una taula de tots els cons, primer el pitjor.&lt;/p&gt; &lt;p&gt;Els cons són una capa del GeoPackage que escriu &lt;i&gt;robot-bridge placements export cones.gpkg --site site&lt;/i&gt;, o el seu CSV; per a un CSV, que no en té, doneu el SRC del recinte. Un con és on era el robot quan va arribar al seu objectiu, i des d'allà el desplaçament del con del recinte: és el que sap la passarel·la, no un aixecament topogràfic.&lt;/p&gt; &lt;p&gt;Al mapa una creu és el pla i un cercle el con, vermell quan és fora de la tolerància. Les desviacions són petites: les línies des de les creus són més llargues pel factor que diu el mapa. Doneu capes de fons, com ara vies, per dibuixar-les a sota.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:asplacedreport -- INPUT="cones.gpkg|layername=placed" TOLERANCE=0.2 OUTPUT=report.pdf&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Background of the map</source>
            <translation>Fons del mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Cones as placed and as planned</source>
            <translation>Cons col·locats i planificats</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Cones within the tolerance</source>
            <translation>Cons dins de la tolerància</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>It is written: {link}</source>
            <translation>S'ha escrit: {link}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Largest deviation [m]</source>
            <translation>Desviació més gran [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Mean deviation [m]</source>
            <translation>Desviació mitjana [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>PDF files (*.pdf)</source>
            <translation>Fitxers PDF (*.pdf)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Pages</source>
            <translation>Pàgines</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Records</source>
            <translation>Registres</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Report</source>
            <translation>Informe</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Root mean square deviation [m]</source>
            <translation>Desviació mitjana quadràtica [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Site CRS (default: the layer's)</source>
            <translation>SRC del recinte (per defecte: el de la capa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>The CRS of the placed cones is not known, as of a CSV: give CRS, the site's, such as EPSG:32633.</source>
            <translation>No es coneix el SRC dels cons col·locats, com en un CSV: doneu CRS, el del recinte, com ara EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Title</source>
            <translation>Títol</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Tolerance [m]</source>
            <translation>Tolerància [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Warnings</source>
            <translation>Avisos</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Writes a PDF of how placed cones stand against their plan: figures, histogram, map and table.</source>
            <translation>Escriu un PDF de com estan els cons col·locats respecte del pla: xifres, histograma, mapa i taula.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>{within} of %n cones are within {tolerance:g} m; the worst is {most:.3f} m off.</source>
            <translation>
                <numerusform>{within} de %n con és dins de {tolerance:g} m; es desvia {most:.3f} m.</numerusform>
                <numerusform>{within} de %n cons són dins de {tolerance:g} m; el pitjor es desvia {most:.3f} m.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>%n trips</source>
            <translation>
                <numerusform>%n viatge</numerusform>
                <numerusform>%n viatges</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>&lt;p&gt;Shares &lt;b&gt;cones&lt;/b&gt; out among &lt;b&gt;robots&lt;/b&gt;. Robots load cones to place, and unload collected ones, at &lt;b&gt;stores&lt;/b&gt;, as often as their capacity asks for. Distances are those of the &lt;b&gt;roads&lt;/b&gt;; without roads they are straight lines, and the log says so.&lt;/p&gt; &lt;p&gt;Fields that layers may have, with the parameters as defaults: cones &lt;i&gt;id, heading, stage, task&lt;/i&gt; (place or collect), &lt;i&gt;demand, service_s&lt;/i&gt;; robots &lt;i&gt;id, capacity, speed, range_m, aboard, collected, ready_s&lt;/i&gt;; stores &lt;i&gt;id, service_s&lt;/i&gt;. Every cone of a lower &lt;b&gt;stage&lt;/b&gt; is done before one of a higher stage is begun.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Objective&lt;/b&gt;: &lt;i&gt;balanced&lt;/i&gt; has the last robot finish as early as possible, &lt;i&gt;distance&lt;/i&gt; drives the fewest metres in all. &lt;b&gt;Method&lt;/b&gt;: &lt;i&gt;pyvrp&lt;/i&gt; works until the time limit is over, &lt;i&gt;preview&lt;/i&gt; is quick; &lt;i&gt;automatic&lt;/i&gt; takes pyvrp where Python has it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Targets&lt;/b&gt; are the stops of each robot in order with their times, &lt;b&gt;paths&lt;/b&gt; the ways between them, &lt;b&gt;plan&lt;/b&gt; is all of it as JSON. A cone that cannot be served is named, and nothing is written.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:assigncones -- CONES=cones.gpkg ROBOTS=robots.gpkg STORES=stores.gpkg ROADS=roads.gpkg CAPACITY=8 TIME_LIMIT=10 TARGETS=targets.gpkg PATHS=paths.gpkg PLAN=plan.json&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Reparteix &lt;b&gt;cons&lt;/b&gt; entre &lt;b&gt;robots&lt;/b&gt;. Els robots carreguen els cons per col·locar, i descarreguen els recollits, als &lt;b&gt;magatzems&lt;/b&gt;, tantes vegades com demana la seva capacitat. Les distàncies són per les &lt;b&gt;vies&lt;/b&gt;; sense vies són línies rectes, i el registre ho diu.&lt;/p&gt; &lt;p&gt;Camps que poden tenir les capes, amb els paràmetres com a valors per defecte: cons &lt;i&gt;id, heading, stage, task&lt;/i&gt; (place o collect), &lt;i&gt;demand, service_s&lt;/i&gt;; robots &lt;i&gt;id, capacity, speed, range_m, aboard, collected, ready_s&lt;/i&gt;; magatzems &lt;i&gt;id, service_s&lt;/i&gt;. Tots els cons d'una &lt;b&gt;etapa&lt;/b&gt; (stage) inferior es fan abans de començar-ne un d'una de superior.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Criteri&lt;/b&gt;: &lt;i&gt;balanced&lt;/i&gt; fa que l'últim robot acabi tan aviat com es pugui, &lt;i&gt;distance&lt;/i&gt; recorre els mínims metres en total. &lt;b&gt;Mètode&lt;/b&gt;: &lt;i&gt;pyvrp&lt;/i&gt; treballa fins que s'acaba el límit de temps, &lt;i&gt;preview&lt;/i&gt; és ràpid; &lt;i&gt;automatic&lt;/i&gt; agafa pyvrp si el Python el té.&lt;/p&gt; &lt;p&gt;Els &lt;b&gt;objectius&lt;/b&gt; són les parades de cada robot per ordre amb els seus temps, els &lt;b&gt;camins&lt;/b&gt; els trajectes entre elles, el &lt;b&gt;pla&lt;/b&gt; és tot això com a JSON. Un con que no es pot servir s'anomena, i no s'escriu res.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:assigncones -- CONES=cones.gpkg ROBOTS=robots.gpkg STORES=stores.gpkg ROADS=roads.gpkg CAPACITY=8 TIME_LIMIT=10 TARGETS=targets.gpkg PATHS=paths.gpkg PLAN=plan.json&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Assign cones to robots</source>
            <translation>Assigna cons a robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>CONES holds no cone: there is nothing to plan.</source>
            <translation>CONES no té cap con: no hi ha res per planificar.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Cones that a robot carries (default of field capacity)</source>
            <translation>Cons que porta un robot (per defecte del camp capacity)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Field of the stage: cones of lower ones come first</source>
            <translation>Camp de l'etapa: els cons d'etapes més baixes van primer</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>JSON (*.json)</source>
            <translation>JSON (*.json)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Method</source>
            <translation>Mètode</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Method that was used</source>
            <translation>Mètode utilitzat</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Metres of all robots</source>
            <translation>Metres de tots els robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Metres that a robot's battery lasts, 0 for any (default of field range_m)</source>
            <translation>Metres que dura la bateria d'un robot, 0 per a qualsevol (per defecte del camp range_m)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>No roads are given: distances and paths are straight lines.</source>
            <translation>No s'han donat vies: distàncies i camins són línies rectes.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Objective</source>
            <translation>Criteri</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Paths</source>
            <translation>Camins</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Planned by {method} along {travel}: the last robot is done after {end_s:.0f} s, {metres:.0f} m in all</source>
            <translation>Planificat amb {method} per {travel}: l'últim robot acaba al cap de {end_s:.0f} s, {metres:.0f} m en total</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Plans which robot places or collects which cone, on which trip, along which roads, and when.</source>
            <translation>Planifica quin robot col·loca o recull quin con, en quin viatge, per quines vies i quan.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Road centrelines (default: straight lines)</source>
            <translation>Eixos de via (per defecte: línies rectes)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robot {id}: {cones} on {trips}, {metres:.0f} m, done after {end_s:.0f} s</source>
            <translation>Robot {id}: {cones} en {trips}, {metres:.0f} m, acaba al cap de {end_s:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robots that drive</source>
            <translation>Robots que circulen</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robots, where they are</source>
            <translation>Robots, on són</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds of a visit to a store (default of its field service_s)</source>
            <translation>Segons d'una visita a un magatzem (per defecte del seu camp service_s)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds to place or collect a cone (default of field service_s)</source>
            <translation>Segons per col·locar o recollir un con (per defecte del camp service_s)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds until the last cone is done</source>
            <translation>Segons fins que està fet l'últim con</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds until the last robot has finished</source>
            <translation>Segons fins que acaba l'últim robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Speed of a robot [m/s] (default of field speed)</source>
            <translation>Velocitat d'un robot [m/s] (per defecte del camp speed)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Stores of cones</source>
            <translation>Magatzems de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Targets</source>
            <translation>Objectius</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The CRS of the cones is not known: give SITE_CRS, such as EPSG:32633.</source>
            <translation>El SRC dels cons no es coneix: doneu SITE_CRS, com ara EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The plan</source>
            <translation>El pla</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The plan cannot be driven: {faults}. Please report this.</source>
            <translation>El pla no es pot recórrer: {faults}. Comuniqueu-ho.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Time limit [s]</source>
            <translation>Límit de temps [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Trips</source>
            <translation>Viatges</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>What is done with cones (default of field task)</source>
            <translation>Què es fa amb els cons (per defecte del camp task)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>What the ways follow</source>
            <translation>Què segueixen els recorreguts</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Where robots go at the end</source>
            <translation>On van els robots al final</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>{name} {given} cannot be opened: check the file and the layer's name.</source>
            <translation>{name} {given} no es pot obrir: comproveu el fitxer i el nom de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>&lt;p&gt;Places a layout of traffic cones, either at a &lt;b&gt;point&lt;/b&gt;, turned to a &lt;b&gt;heading&lt;/b&gt; (degrees clockwise from north), or along a &lt;b&gt;line&lt;/b&gt; such as a road's centreline, from &lt;b&gt;start&lt;/b&gt; metres after its beginning. The layer has an id, the order of placing, the heading of travel, the colour and the role of each cone.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Dimensions&lt;/b&gt; change the standard's: &lt;code&gt;vehicle_width=1.7; lane_offset=3&lt;/code&gt;. The log lists those of the layout with their values. A wrong name or value is refused with what there is.&lt;/p&gt; &lt;p&gt;Every cone is &lt;b&gt;checked&lt;/b&gt;: on one of the surfaces (of the allowed classes), away from obstacles and from other cones. What is wrong becomes a layer of findings with the cone's id and the reason; the cones are placed nevertheless.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:conelayout -- LAYOUT=iso3888_1 POINT="640432,5193486.2 [EPSG:32633]" HEADING=90 DIMENSIONS="vehicle_width=1.7; exit_length=15" SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Col·loca una disposició de cons de trànsit, o bé en un &lt;b&gt;punt&lt;/b&gt;, girada cap a un &lt;b&gt;rumb&lt;/b&gt; (graus en sentit horari des del nord), o bé al llarg d'una &lt;b&gt;línia&lt;/b&gt; com ara un eix de via, a partir de &lt;b&gt;start&lt;/b&gt; metres del seu començament. La capa té de cada con un identificador, l'ordre de col·locació, el rumb de circulació, el color i el paper.&lt;/p&gt; &lt;p&gt;Les &lt;b&gt;dimensions&lt;/b&gt; canvien les de la norma: &lt;code&gt;vehicle_width=1.7; lane_offset=3&lt;/code&gt;. El registre llista les de la disposició amb els seus valors. Un nom o valor equivocat es refusa dient què hi ha.&lt;/p&gt; &lt;p&gt;Cada con es &lt;b&gt;comprova&lt;/b&gt;: en una de les superfícies (de les classes permeses), lluny d'obstacles i d'altres cons. El que no està bé va a una capa de troballes amb l'identificador del con i el motiu; els cons es col·loquen igualment.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:conelayout -- LAYOUT=iso3888_1 POINT="640432,5193486.2 [EPSG:32633]" HEADING=90 DIMENSIONS="vehicle_width=1.7; exit_length=15" SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>&lt;p&gt;Reads cones from a &lt;b&gt;CSV file&lt;/b&gt; in UTF-8, from a &lt;b&gt;track&lt;/b&gt; of Formula Student, or from a &lt;b&gt;layer&lt;/b&gt;. Tracks are YAML with &lt;i&gt;cones_left&lt;/i&gt;, &lt;i&gt;cones_right&lt;/i&gt;, &lt;i&gt;cones_orange&lt;/i&gt; and &lt;i&gt;cones_orange_big&lt;/i&gt;, SDF with models of cones, CSV with columns such as &lt;i&gt;blue_x&lt;/i&gt; and &lt;i&gt;blue_y&lt;/i&gt; for each colour, or CSV without a head line: colour, x, y. Of other tables the columns are named by parameters; only those of x and y are needed, and not even those for a layer of points with a CRS, which is taken as it lies. A file or layer with several layouts gives one of them, by &lt;b&gt;LAYOUT_FIELD&lt;/b&gt; and &lt;b&gt;LAYOUT&lt;/b&gt;.&lt;/p&gt; &lt;p&gt;Metres of a table are turned by &lt;b&gt;rotation&lt;/b&gt; (degrees, counter-clockwise) and then moved to the &lt;b&gt;origin&lt;/b&gt;. A row that cannot be read is named with its column, and nothing is placed.&lt;/p&gt; &lt;p&gt;Every cone is &lt;b&gt;checked&lt;/b&gt; as those of &lt;i&gt;Cone layout&lt;/i&gt; are.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importconelayout -- FILE=cone_layouts.csv COLOUR_FIELD=colour LAYOUT_FIELD=track LAYOUT=eufs_skidpad ORIGIN="640520,5193530 [EPSG:32633]" ROTATION=90 SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Llegeix cons d'un &lt;b&gt;fitxer CSV&lt;/b&gt; en UTF-8, d'una &lt;b&gt;pista&lt;/b&gt; de Formula Student o d'una &lt;b&gt;capa&lt;/b&gt;. Les pistes són YAML amb &lt;i&gt;cones_left&lt;/i&gt;, &lt;i&gt;cones_right&lt;/i&gt;, &lt;i&gt;cones_orange&lt;/i&gt; i &lt;i&gt;cones_orange_big&lt;/i&gt;, SDF amb models de cons, CSV amb columnes com &lt;i&gt;blue_x&lt;/i&gt; i &lt;i&gt;blue_y&lt;/i&gt; per a cada color, o CSV sense línia de capçalera: color, x, y. De les altres taules, les columnes s'anomenen amb paràmetres; només calen les de x i y, i ni tan sols aquestes per a una capa de punts amb SRC, que es pren tal com és. Un fitxer o una capa amb diverses disposicions en dona una, amb &lt;b&gt;LAYOUT_FIELD&lt;/b&gt; i &lt;b&gt;LAYOUT&lt;/b&gt;.&lt;/p&gt; &lt;p&gt;Els metres d'una taula es giren segons &lt;b&gt;rotation&lt;/b&gt; (graus, en sentit antihorari) i després es mouen a l'&lt;b&gt;origen&lt;/b&gt;. Una fila que no es pot llegir s'anomena amb la seva columna, i no es col·loca res.&lt;/p&gt; &lt;p&gt;Cada con es &lt;b&gt;comprova&lt;/b&gt; com els de &lt;i&gt;Disposició de cons&lt;/i&gt;.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importconelayout -- FILE=cone_layouts.csv COLOUR_FIELD=colour LAYOUT_FIELD=track LAYOUT=eufs_skidpad ORIGIN="640520,5193530 [EPSG:32633]" ROTATION=90 SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Against the direction of the line</source>
            <translation>En sentit contrari a la línia</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Begin so far along the line [m]</source>
            <translation>Comença a aquesta distància al llarg de la línia [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Both FILE and INPUT are</source>
            <translation>S'han donat FILE i INPUT alhora</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Both POINT and LINE are</source>
            <translation>S'han donat POINT i LINE alhora</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>CSV file, or track of Formula Student (YAML, SDF)</source>
            <translation>Fitxer CSV o pista de Formula Student (YAML, SDF)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of colours</source>
            <translation>Columna dels colors</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of headings, clockwise from the y axis [degrees]</source>
            <translation>Columna dels rumbs, des de l'eix y en sentit horari [graus]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of ids</source>
            <translation>Columna dels ids</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of roles</source>
            <translation>Columna dels papers</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of the order of placing</source>
            <translation>Columna de l'ordre de col·locació</translation>
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
            <translation>Columna de la disposició</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Cone layout</source>
            <translation>Disposició de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Cone layouts ({kinds});;All files (*)</source>
            <translation>Disposicions de cons ({kinds});;Tots els fitxers (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>DIMENSIONS has {part!r}, which is not name=value with a number: write such as spacing=15.</source>
            <translation>DIMENSIONS té {part!r}, que no és nom=valor amb un nombre: escriviu per exemple spacing=15.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Dimensions other than the standard's, as name=value; ...</source>
            <translation>Dimensions diferents de les de la norma, com a nom=valor; ...</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>FILE {file} is none that is read: give one of {kinds}.</source>
            <translation>FILE: {file} no és de cap tipus que es llegeixi: doneu-ne un de {kinds}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Heading, clockwise from north [degrees]</source>
            <translation>Rumb, des del nord en sentit horari [graus]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Id of the line's feature (default: the only one)</source>
            <translation>Id de l'entitat de la línia (per defecte: l'única)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Ids begin with (default: the layout)</source>
            <translation>Els ids comencen amb (per defecte: la disposició)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Import cone layout</source>
            <translation>Importa una disposició de cons</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Layer, instead of a file</source>
            <translation>Capa, en lloc d'un fitxer</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Layout</source>
            <translation>Disposició</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Line to lie along, instead of a place</source>
            <translation>Línia per on s'estén, en lloc d'un punt</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Name (default: the layout's, else the file's)</source>
            <translation>Nom (per defecte: el de la disposició, si no el del fitxer)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Neither FILE nor INPUT is</source>
            <translation>No s'ha donat ni FILE ni INPUT</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Neither POINT nor LINE is</source>
            <translation>No s'ha donat ni POINT ni LINE</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>ORIGIN is not given: say where the table's 0,0 goes.</source>
            <translation>No s'ha donat ORIGIN: digueu on va el 0,0 de la taula.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Place of the layout's origin</source>
            <translation>Lloc de l'origen de la disposició</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Places a standard cone layout at a point and heading or along a line, and checks every cone.</source>
            <translation>Col·loca una disposició de cons normalitzada en un punt i rumb o al llarg d'una línia, i comprova cada con.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Places the cones of a CSV file or a layer, turned and moved to their place, and checks them.</source>
            <translation>Col·loca els cons d'un fitxer CSV o d'una capa, girats i moguts al seu lloc, i els comprova.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Rotation, counter-clockwise [degrees]</source>
            <translation>Rotació, en sentit antihorari [graus]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The feature {id} of {layer} has no line with a length and a place in the site's CRS: correct it, or choose another.</source>
            <translation>L'entitat {id} de {layer} no té cap línia amb longitud i amb lloc en el SRC del lloc: corregiu-la, o trieu-ne una altra.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The feature {id} of {sourcename} has {lines} lines: split it, or choose one that has one.</source>
            <translation>L'entitat {id} de {sourcename} té {lines} línies: dividiu-la, o trieu-ne una que en tingui una.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The layer {sourcename} has {found}: choose one line by LINE_ID, or select it and tick 'Selected features only'.</source>
            <translation>La capa {sourcename} té {found}: trieu una línia amb LINE_ID, o seleccioneu-la i marqueu «Només les entitats seleccionades».</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The one layout to take, by that column</source>
            <translation>L'única disposició que s'agafa, segons aquesta columna</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Where the table's 0,0 goes</source>
            <translation>On va el 0,0 de la taula</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>no feature {wanted}</source>
            <translation>cap entitat {wanted}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>not exactly one feature</source>
            <translation>no exactament una entitat</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>{how} given: give a CSV file, or a layer.</source>
            <translation>{how}: doneu un fitxer CSV o una capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>{how} given: give the place of the layout, or a line that it lies along.</source>
            <translation>{how}: doneu el lloc de la disposició, o una línia per on s'estengui.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>&lt;p&gt;Writes a robot map as other robots and people read it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Robot map&lt;/b&gt;: a file of &lt;i&gt;fleet:exportrobotmap&lt;/i&gt; or of the gateway, text or binary.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formats&lt;/b&gt;, several at once:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;occupancy&lt;/i&gt;: occupancy grid for Nav2 (PGM and YAML). What a wall touches is occupied, so thin walls have no gap; courtyards are free; the inside of obstacles is unknown, or occupied on request. The frame of the grid is the site frame.&lt;/li&gt; &lt;li&gt;&lt;i&gt;keepout&lt;/i&gt;: mask for Nav2's keepout filter, from the keepout layer, with the filter's parameters.&lt;/li&gt; &lt;li&gt;&lt;i&gt;speed&lt;/i&gt;: mask for Nav2's speed filter, from the speed layer and its expression in m/s. A limit is never rounded up; where areas overlap the lower one holds.&lt;/li&gt; &lt;li&gt;&lt;i&gt;geojson&lt;/i&gt;: obstacles and segments in WGS 84 (RFC 7946).&lt;/li&gt; &lt;li&gt;&lt;i&gt;geopackage&lt;/i&gt;: the same in the site's CRS.&lt;/li&gt; &lt;li&gt;&lt;i&gt;svg&lt;/i&gt;, &lt;i&gt;png&lt;/i&gt;: a picture for people.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;&lt;b&gt;Keepout and speed layers&lt;/b&gt; are polygons in any CRS. Where the map's place is not known, layers are taken to be in its own metres, and a warning says so; &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt; give it one.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Robots drive over&lt;/b&gt; obstacles that are lower: 0 keeps every kerb. Ramps are always driven on, stairs are obstacles, also from the side.&lt;/p&gt; &lt;p&gt;Existing files are replaced, each in one step, after all of them could be made. docs/navigation-maps.md says what is in each.&lt;/p&gt; &lt;p&gt;From a script, with no display:&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportnavigationmap -- MAP=campus.txt FORMATS=occupancy FORMATS=svg RESOLUTION=0.05 OUTPUT=campus&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Escriu un mapa de robots tal com el llegeixen altres robots i les persones.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Mapa de robots&lt;/b&gt;: un fitxer de &lt;i&gt;fleet:exportrobotmap&lt;/i&gt; o de la passarel·la, de text o binari.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formats&lt;/b&gt;, diversos alhora:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;occupancy&lt;/i&gt;: graella d'ocupació per a Nav2 (PGM i YAML). El que toca una paret és ocupat, així les parets primes no tenen buits; els patis són lliures; l'interior dels obstacles és desconegut, o ocupat si es demana. El marc de la graella és el marc del recinte.&lt;/li&gt; &lt;li&gt;&lt;i&gt;keepout&lt;/i&gt;: màscara per al filtre keepout de Nav2, de la capa de zones prohibides, amb els paràmetres del filtre.&lt;/li&gt; &lt;li&gt;&lt;i&gt;speed&lt;/i&gt;: màscara per al filtre speed de Nav2, de la capa de velocitat i la seva expressió en m/s. Un límit no s'arrodoneix mai cap amunt; on les àrees se superposen val el més baix.&lt;/li&gt; &lt;li&gt;&lt;i&gt;geojson&lt;/i&gt;: obstacles i segments en WGS 84 (RFC 7946).&lt;/li&gt; &lt;li&gt;&lt;i&gt;geopackage&lt;/i&gt;: el mateix al SRC del recinte.&lt;/li&gt; &lt;li&gt;&lt;i&gt;svg&lt;/i&gt;, &lt;i&gt;png&lt;/i&gt;: una imatge per a les persones.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;Les &lt;b&gt;capes de zones prohibides i de velocitat&lt;/b&gt; són polígons en qualsevol SRC. On no se sap el lloc del mapa, les capes es prenen en els seus propis metres, i un avís ho diu; &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; i &lt;i&gt;ROTATION&lt;/i&gt; n'hi donen un.&lt;/p&gt; &lt;p&gt;Els &lt;b&gt;robots passen per sobre&lt;/b&gt; dels obstacles més baixos: 0 conserva cada vorada. Per les rampes s'hi circula sempre, les escales són obstacles, també de costat.&lt;/p&gt; &lt;p&gt;Els fitxers existents se substitueixen, cadascun d'un sol cop, quan tots s'han pogut fer. docs/navigation-maps.md diu què hi ha a cadascun.&lt;/p&gt; &lt;p&gt;Des d'un script, sense pantalla:&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportnavigationmap -- MAP=campus.txt FORMATS=occupancy FORMATS=svg RESOLUTION=0.05 OUTPUT=campus&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Areas with a speed limit</source>
            <translation>Zones amb límit de velocitat</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Export navigation map</source>
            <translation>Exporta el mapa de navegació</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>FORMATS has {format}, which needs {name}: give it, or leave {format} out.</source>
            <translation>FORMATS té {format}, que necessita {name}: doneu-lo, o traieu {format}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>FORMATS is {formats}: choose of {known}.</source>
            <translation>FORMATS és {formats}: trieu entre {known}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>File of format {name}</source>
            <translation>Fitxer de format {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Files</source>
            <translation>Fitxers</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Formats</source>
            <translation>Formats</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Inside of obstacles in the occupancy grid</source>
            <translation>Interior dels obstacles a la graella d'ocupació</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Keepout areas</source>
            <translation>Zones prohibides</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Making {format}</source>
            <translation>S'està fent {format}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>NAME {name!r} is no file's name: leave out folders and leading dots.</source>
            <translation>NAME {name!r} no és un nom de fitxer: traieu les carpetes i els punts inicials.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Name of the files (default: the robot map's)</source>
            <translation>Nom dels fitxers (per defecte: el del mapa de robots)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 keepout mask</source>
            <translation>màscara de zones prohibides de Nav2</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 occupancy grid</source>
            <translation>graella d'ocupació de Nav2</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 speed mask</source>
            <translation>màscara de velocitat de Nav2</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Robots drive over what is lower than [m]</source>
            <translation>Els robots passen per sobre del que és més baix que [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Side of a cell of grid and masks [m]</source>
            <translation>Costat d'una cel·la de la graella i les màscares [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Speed limit of each area [m/s]</source>
            <translation>Límit de velocitat de cada zona [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>The coordinates of the keepout and speed layers are taken as the map's own metres.</source>
            <translation>Les coordenades de les capes de zones prohibides i de velocitat es prenen com a metres del mateix mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>The navigation map</source>
            <translation>El mapa de navegació</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Writes a robot map as Nav2 occupancy grid and masks, GeoJSON, GeoPackage, SVG or PNG.</source>
            <translation>Escriu un mapa de robots com a graella d'ocupació i màscares de Nav2, GeoJSON, GeoPackage, SVG o PNG.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>above 0, such as 0.05</source>
            <translation>superior a 0, com ara 0.05</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>empty</source>
            <translation>buit</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>occupied</source>
            <translation>ocupat</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>of 0 or more</source>
            <translation>de 0 o més</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>unknown</source>
            <translation>desconegut</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{name} is {value}: give a number of metres {wanted}.</source>
            <translation>{name} és {value}: doneu un nombre de metres {wanted}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{parameter} {layer} cannot be opened: check the file and the layer's name.</source>
            <translation>{parameter} {layer} no es pot obrir: comproveu el fitxer i el nom de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{target} is the robot map itself: choose another NAME or OUTPUT.</source>
            <translation>{target} és el mateix mapa de robots: trieu un altre NAME o OUTPUT.</translation>
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
                <numerusform>%n aresta</numerusform>
                <numerusform>%n arestes</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>&lt;p&gt;Writes the network of road centrelines as other robots read it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formats&lt;/b&gt;, several at once:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;nav2&lt;/i&gt;: graph for Nav2's route server (GeoJSON). Nav2 drives straight from node to node, so every point of a road becomes a node.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lif&lt;/i&gt;: VDMA's Layout Interchange Format 1.0, for masters of VDA 5050 vehicles (JSON). Roads that are not straight have a trajectory.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lanelet2&lt;/i&gt;: lanes with borders for Lanelet2 and Autoware (OSM). Traffic keeps to the right, or to the left on request.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;Roads that are driven both ways become two edges; one-way roads one. Closed roads are left out, and so are edges that lead through a polygon of the &lt;b&gt;areas that must not be driven through&lt;/b&gt;. Speeds go over as limits.&lt;/p&gt; &lt;p&gt;Coordinates are metres in the &lt;b&gt;site frame&lt;/b&gt;, as on robot maps: &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt;, else as the project has it. Nav2 keeps 32 bits of a coordinate: give an origin on the site, or a warning says by how much places move.&lt;/p&gt; &lt;p&gt;Existing files are replaced, each in one step, after all of them could be made. docs/navigation-maps.md says what is in each.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportroadnetwork -- ROADS=roads.gpkg FORMATS=nav2 FORMATS=lif ORIGIN="640420,5193480" NAME=campus OUTPUT=graphs&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Escriu la xarxa d'eixos de via tal com la llegeixen altres robots.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formats&lt;/b&gt;, diversos alhora:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;nav2&lt;/i&gt;: graf per al servidor de rutes de Nav2 (GeoJSON). Nav2 circula recte de node a node, per això cada punt d'una via es converteix en un node.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lif&lt;/i&gt;: Layout Interchange Format 1.0 de la VDMA, per a controls de vehicles VDA 5050 (JSON). Les vies que no són rectes tenen una trajectòria.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lanelet2&lt;/i&gt;: carrils amb vores per a Lanelet2 i Autoware (OSM). Es circula per la dreta, o per l'esquerra si es demana.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;Les vies de dos sentits es converteixen en dues arestes; les de sentit únic, en una. Les vies tancades queden fora, i també les arestes que passen per un polígon de les &lt;b&gt;àrees per on no s'ha de circular&lt;/b&gt;. Les velocitats hi passen com a límits.&lt;/p&gt; &lt;p&gt;Les coordenades són metres en el &lt;b&gt;marc del recinte&lt;/b&gt;, com als mapes de robots: &lt;i&gt;ORIGIN&lt;/i&gt; i &lt;i&gt;ROTATION&lt;/i&gt;, si no el del projecte. Nav2 conserva 32 bits d'una coordenada: doneu un origen al recinte, o un avís dirà quant es mouen els llocs.&lt;/p&gt; &lt;p&gt;Els fitxers existents se substitueixen, cadascun d'un sol cop, quan tots s'han pogut fer. docs/navigation-maps.md diu què hi ha a cadascun.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportroadnetwork -- ROADS=roads.gpkg FORMATS=nav2 FORMATS=lif ORIGIN="640420,5193480" NAME=campus OUTPUT=graphs&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Edges</source>
            <translation>Arestes</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Export road network</source>
            <translation>Exporta la xarxa de vies</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>FORMATS is empty: choose of {known}.</source>
            <translation>FORMATS és buit: trieu entre {known}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 map (OSM)</source>
            <translation>Mapa Lanelet2 (OSM)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 needs longitudes and latitudes, and the CRS of the roads has no place on the Earth: give the layer its CRS, or leave lanelet2 out.</source>
            <translation>Lanelet2 necessita longituds i latituds, i el SRC de les vies no té lloc a la Terra: doneu a la capa el seu SRC, o deixeu fora lanelet2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 reads lanes the wrong way round where corners are tighter than lanes are wide: {count} here, the first at ({x:.2f}, {y:.2f}). Draw the roads there smoother, or give them less width.</source>
            <translation>Lanelet2 llegeix els carrils al revés on les corbes són més tancades que l'amplada dels carrils: aquí {count}, el primer a ({x:.2f}, {y:.2f}). Dibuixeu-hi les vies més suaus, o doneu-los menys amplada.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Name of the files</source>
            <translation>Nom dels fitxers</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Nav2 keeps 32 bits of a coordinate, which here moves nodes by up to {metres:.2f} m: give ORIGIN, a place of the site, for robots and their maps alike.</source>
            <translation>Nav2 conserva 32 bits d'una coordenada, cosa que aquí mou els nodes fins a {metres:.2f} m: doneu ORIGIN, un lloc del recinte, tant per als robots com per als seus mapes.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Nav2 route graph (GeoJSON)</source>
            <translation>Graf de rutes de Nav2 (GeoJSON)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Roads</source>
            <translation>Vies</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Robots' name for the site frame</source>
            <translation>Nom del marc del recinte per als robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>The road network</source>
            <translation>La xarxa de vies</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Traffic keeps to the left (Lanelet2)</source>
            <translation>Es circula per l'esquerra (Lanelet2)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Type of vehicle that drives here (LIF)</source>
            <translation>Tipus de vehicle que hi circula (LIF)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>VDMA LIF, for VDA 5050 (JSON)</source>
            <translation>VDMA LIF, per a VDA 5050 (JSON)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Writes the road network as a Nav2 route graph, a VDMA LIF layout or a Lanelet2 map.</source>
            <translation>Escriu la xarxa de vies com a graf de rutes de Nav2, disposició VDMA LIF o mapa Lanelet2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>{name} {value!r} cannot be used: give a plain word.</source>
            <translation>{name} {value!r} no es pot fer servir: doneu una paraula simple.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>&lt;p&gt;Writes the obstacles in a window of the site as a map that robots read: oriented segments with free space to their right, grouped by kind. Robots get metres in the &lt;b&gt;site frame&lt;/b&gt;: a projected CRS, an origin in it and a rotation.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Obstacle layers&lt;/b&gt;: lines and polygons, several at once, in any CRS. Curves become chords (2 cm). What the window cuts becomes open chains; no wall is invented on the border.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Window&lt;/b&gt;: a centre with width and height in metres, or an extent. Positions may name their CRS, as in &lt;i&gt;12.5,48.1 [EPSG:4326]&lt;/i&gt;; without one they are in the site CRS.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Site CRS&lt;/b&gt;: in metres, such as the local UTM zone. EPSG:3857 is refused, because its metres are not metres. Default: the project's CRS; without a project the layers' own. A local engineering CRS is used as it is.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Height, foot, label, outdoors&lt;/b&gt;: QGIS expressions; the foot is where a feature begins above the ground, and its height counts from there. What a layer keeps (menu Fleet Supervisor, Layer roles) wins over these. There its role makes flights of risers of a layer (stairs) or surfaces without height (ramp), its filter says which features count, and points of furniture get a shape. Default: the field &lt;i&gt;height&lt;/i&gt; or &lt;i&gt;height_m&lt;/i&gt;, on the ground, the layer's name, true. Where no height is known, the default height is used, said in a warning and marked &lt;i&gt;h=est&lt;/i&gt; in the map.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Map profile&lt;/b&gt;: a file that says by layer name what layers are: &lt;i&gt;openstreetmap&lt;/i&gt;, &lt;i&gt;upc_campus_nord&lt;/i&gt; or the path of one's own. It wins over what the layers keep.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Smaller maps&lt;/b&gt; (advanced, each off unless asked for): only what the robot's plane meets, without walls between or inside buildings, lines joined, fewer corners, no short segments, heights in steps. The log says how many obstacles and segments there were before and after. Walls between buildings, corners and short segments need the Python package shapely 2.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Format&lt;/b&gt;: text; binary (the text compressed, with a check sum), which needs the Python package zstandard; compact (about a third of binary, whole centimetres), which needs cbor2 instead. The file &lt;i&gt;docs/robot-map.md&lt;/i&gt; of the project describes them, and exports from a script.&lt;/p&gt; &lt;p&gt;Broken geometry is repaired where that is safe and left out where it is not. Each time a warning names the layer and the feature; the export goes on.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Escriu els obstacles d'una finestra del recinte com un mapa que llegeixen els robots: segments orientats amb espai lliure a la dreta, agrupats per tipus. Els robots reben metres al &lt;b&gt;marc del recinte&lt;/b&gt;: un SRC projectat, un origen i una rotació.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Capes d'obstacles&lt;/b&gt;: línies i polígons, diverses alhora, en qualsevol SRC. Les corbes esdevenen cordes (2 cm). El que talla la finestra esdevé cadenes obertes; no s'inventa cap paret a la vora.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Finestra&lt;/b&gt;: un centre amb amplada i alçada en metres, o una extensió. Les posicions poden dir el seu SRC, com a &lt;i&gt;12.5,48.1 [EPSG:4326]&lt;/i&gt;; sense, són al SRC del recinte.&lt;/p&gt; &lt;p&gt;&lt;b&gt;SRC del recinte&lt;/b&gt;: en metres, com ara la zona UTM local. EPSG:3857 es refusa, perquè els seus metres no són metres. Per defecte: el SRC del projecte; sense projecte, el de les capes. Un SRC local d'enginyeria es fa servir tal com és.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Alçada, peu, etiqueta, exterior&lt;/b&gt;: expressions del QGIS; el peu és on comença una entitat sobre el terra, i l'alçada compta des d'allà. El que guarda una capa (menú Fleet Supervisor, Papers de les capes) passa per davant. Allà el seu paper fa d'una capa trams d'escala (stairs) o superfícies sense alçada (ramp), el seu filtre diu quines entitats compten, i els punts de mobiliari reben una forma. Per defecte: el camp &lt;i&gt;height&lt;/i&gt; o &lt;i&gt;height_m&lt;/i&gt;, a terra, el nom de la capa, cert. On no se sap l'alçada es fa servir l'alçada per defecte, amb un avís i la marca &lt;i&gt;h=est&lt;/i&gt; al mapa.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Perfil de mapa&lt;/b&gt;: un fitxer que diu pel nom què són les capes: &lt;i&gt;openstreetmap&lt;/i&gt;, &lt;i&gt;upc_campus_nord&lt;/i&gt; o el camí d'un de propi. Passa per davant del que guarden les capes.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Mapes més petits&lt;/b&gt; (avançat, cadascun desactivat si no es demana): només el que talla el pla del robot, sense parets entre edificis ni a dins, línies unides, menys cantonades, sense segments curts, alçades en esglaons. El registre diu quants obstacles i segments hi havia abans i després. Les parets entre edificis, les cantonades i els segments curts necessiten el paquet de Python shapely 2.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Format&lt;/b&gt;: text; binari (el text comprimit, amb una suma de control), que necessita el paquet de Python zstandard; compacte (un terç del binari, centímetres sencers), que necessita cbor2. El fitxer &lt;i&gt;docs/robot-map.md&lt;/i&gt; del projecte els descriu, i també les exportacions des d'un script.&lt;/p&gt; &lt;p&gt;La geometria trencada es repara on és segur i queda fora on no ho és. Cada vegada un avís anomena la capa i l'entitat; l'exportació continua.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Compactness [bytes/m²]</source>
            <translation>Compacitat [bytes/m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Export robot map</source>
            <translation>Exporta el mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Foot of each feature above ground [m] (default: on it)</source>
            <translation>On comença cada entitat sobre el terra [m] (per defecte: a terra)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Height of each feature [m] (default: its field height)</source>
            <translation>Alçada de cada entitat [m] (per defecte: el seu camp height)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Height where none is known, marked as estimated [m]</source>
            <translation>Alçada on no se'n coneix cap, marcada com a estimada [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Label of each feature (default: the layer's name)</source>
            <translation>Etiqueta de cada entitat (per defecte: el nom de la capa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Robot map</source>
            <translation>Mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Robot map, text (*.txt);;Robot map, binary (*.rmap)</source>
            <translation>Mapa de robots, text (*.txt);;Mapa de robots, binari (*.rmap)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Segments</source>
            <translation>Segments</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Size of the file [bytes]</source>
            <translation>Mida del fitxer [bytes]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Such as "clearance" of arches, or 2.2 for signs; the height of a feature counts from there. The upper height of the robot's plane leaves out what begins above it.</source>
            <translation>Com ara "clearance" dels arcs, o 2.2 per als senyals; l'alçada d'una entitat es compta des d'allà. L'alçada superior del pla del robot omet el que comença per sobre.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>There is no obstacle in the window, and no layer reaches it: the layers lie from ({x_min:.0f}, {y_min:.0f}) to ({x_max:.0f}, {y_max:.0f}) in the site frame. Check the order of the window's numbers, their CRS and the site CRS. To a robot this map says that all is free.</source>
            <translation>No hi ha cap obstacle a la finestra, i cap capa no hi arriba: les capes són entre ({x_min:.0f}, {y_min:.0f}) i ({x_max:.0f}, {y_max:.0f}) en el marc del recinte. Comproveu l'ordre dels números de la finestra, el seu SRC i el SRC del recinte. A un robot aquest mapa li diu que tot és lliure.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>There is no obstacle in the window: check its place and the site CRS.</source>
            <translation>No hi ha cap obstacle a la finestra: comproveu el lloc i el SRC del recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Whether each feature is outdoors (default: true)</source>
            <translation>Si cada entitat és a l'exterior (per defecte: cert)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Window {width:g} m x {height:g} m = {area:.0f} m², from ({x_min:.2f}, {y_min:.2f}) to ({x_max:.2f}, {y_max:.2f}) in the site frame</source>
            <translation>Finestra {width:g} m x {height:g} m = {area:.0f} m², de ({x_min:.2f}, {y_min:.2f}) a ({x_max:.2f}, {y_max:.2f}) en el marc del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Writes the obstacles of line and polygon layers inside a window as a map that robots read.</source>
            <translation>Escriu els obstacles de capes de línies i polígons dins d'una finestra com a mapa que llegeixen els robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>{size} bytes in binary, {ratio:.3g} bytes/m²</source>
            <translation>{size} bytes en binari, {ratio:.3g} bytes/m²</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>{size} bytes of text, {ratio:.3g} bytes/m² (paper 1: about 3 bytes/m² as text)</source>
            <translation>{size} bytes de text, {ratio:.3g} bytes/m² (article 1: uns 3 bytes/m² com a text)</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>%n tiles</source>
            <translation>
                <numerusform>%n tessel·la</numerusform>
                <numerusform>%n tessel·les</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>&lt;p&gt;Writes one robot map for each tile, as &lt;i&gt;Export robot map&lt;/i&gt; does for one window, and an index: a polygon for each tile with its file, border, counts and bytes. The layers are read once.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Grid&lt;/b&gt;: tiles of one size from the left-lower corner of the extent; the last ones reach beyond it. &lt;b&gt;Route&lt;/b&gt;: tiles centred on the lines of a layer, so close that two that follow each other share the overlap. Sizes are in metres along the site's axes.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Advanced&lt;/b&gt;: obstacles are reduced as in &lt;i&gt;Export robot map&lt;/i&gt;, before the tiles are cut. The log says how many obstacles and segments the whole area had before and after.&lt;/p&gt; &lt;p&gt;An obstacle has the same id in every tile that it reaches into. Either every tile and the index are there at the end, or, after a cancel or an error, none of them.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Escriu un mapa de robots per a cada tessel·la, com &lt;i&gt;Exporta el mapa de robots&lt;/i&gt; fa per a una finestra, i un índex: un polígon per a cada tessel·la amb el seu fitxer, la vora, els recomptes i els bytes. Les capes es llegeixen una vegada.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Graella&lt;/b&gt;: tessel·les d'una mida des de la cantonada inferior esquerra de l'extensió; les últimes la sobrepassen. &lt;b&gt;Ruta&lt;/b&gt;: tessel·les centrades a les línies d'una capa, tan juntes que dues de seguides comparteixin el solapament. Les mides són en metres al llarg dels eixos del recinte.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Avançat&lt;/b&gt;: els obstacles es redueixen com a &lt;i&gt;Exporta el mapa de robots&lt;/i&gt;, abans de tallar les tessel·les. El registre diu quants obstacles i segments tenia tota l'àrea abans i després.&lt;/p&gt; &lt;p&gt;Un obstacle té el mateix identificador a cada tessel·la on arriba. O bé al final hi són totes les tessel·les i l'índex, o bé, després d'una cancel·lació o d'un error, cap.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Both EXTENT and ROUTE are given: give one of them, for a grid or for tiles along a route.</source>
            <translation>S'han donat EXTENT i ROUTE alhora: doneu-ne un, per a una graella o per a tessel·les al llarg d'una ruta.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Export robot map tiles</source>
            <translation>Exporta tessel·les del mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Extent of a grid (or choose a route)</source>
            <translation>Extensió d'una graella (o trieu una ruta)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Folder of the tiles</source>
            <translation>Carpeta de les tessel·les</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Height of a tile, along y [m]</source>
            <translation>Alçada d'una tessel·la, en y [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Index of the tiles</source>
            <translation>Índex de les tessel·les</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Leave out tiles without obstacles</source>
            <translation>Omet les tessel·les sense obstacles</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Neither EXTENT nor ROUTE is given: give an extent for a grid, or a layer of lines to follow.</source>
            <translation>No s'ha donat ni EXTENT ni ROUTE: doneu una extensió per a una graella, o una capa de línies a seguir.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>OUTPUT {folder} is a file: choose a folder for the tiles.</source>
            <translation>OUTPUT {folder} és un fitxer: trieu una carpeta per a les tessel·les.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>OVERLAP is {overlap} m: give 0 or more, and at most nine tenths of a tile's side.</source>
            <translation>OVERLAP és {overlap} m: doneu 0 o més, i com a màxim nou dècimes del costat d'una tessel·la.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Obstacles in all tiles</source>
            <translation>Obstacles a totes les tessel·les</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE holds no line: choose a layer with the route to export along.</source>
            <translation>ROUTE no té cap línia: trieu una capa amb la ruta al llarg de la qual exportar.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE {route} cannot be opened: choose a layer of lines.</source>
            <translation>ROUTE {route} no es pot obrir: trieu una capa de línies.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE: feature {id} of {layer}: {doubts}. Correct the filter of the layer.</source>
            <translation>ROUTE: entitat {id} de {layer}: {doubts}. Corregiu el filtre de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Route, instead of a grid</source>
            <translation>Ruta, en lloc d'una graella</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Segments in all tiles</source>
            <translation>Segments a totes les tessel·les</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Size of all tiles [bytes]</source>
            <translation>Mida de totes les tessel·les [bytes]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>That would be {count} tiles, and {most_tiles} are the most: choose larger tiles, less overlap or a smaller area.</source>
            <translation>Serien {count} tessel·les, i {most_tiles} són el màxim: trieu tessel·les més grans, menys solapament o una zona més petita.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The index</source>
            <translation>L'índex</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The set of tiles</source>
            <translation>El joc de tessel·les</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The {name} of a tile is {value} m: give at least 1 m, such as 100.</source>
            <translation>La mida ({name}) d'una tessel·la és {value} m: doneu almenys 1 m, com ara 100.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>There is no obstacle in any tile: check their place and the site CRS.</source>
            <translation>No hi ha cap obstacle a cap tessel·la: comproveu el lloc i el SRC del recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Tiles</source>
            <translation>Tessel·les</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>What neighbouring tiles share [m]</source>
            <translation>El que comparteixen tessel·les veïnes [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Width of a tile, along x [m]</source>
            <translation>Amplada d'una tessel·la, en x [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Writes many robot maps, in a grid or along a route, and a layer that tells which is where.</source>
            <translation>Escriu molts mapes de robots, en graella o al llarg d'una ruta, i una capa que diu on és cadascun.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>{tiles}, {segments}, {size} bytes</source>
            <translation>{tiles}, {segments}, {size} bytes</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>&lt;p&gt;Reads a map of Nav2: the &lt;b&gt;YAML&lt;/b&gt; and the image that it names (PGM, PNG, BMP or JPEG), in the modes &lt;i&gt;trinary&lt;/i&gt;, &lt;i&gt;scale&lt;/i&gt; and &lt;i&gt;raw&lt;/i&gt;, with its thresholds, &lt;i&gt;negate&lt;/i&gt;, and origin with yaw.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Raster&lt;/b&gt;: a value for each cell, 0 free to 100 occupied, -1 unknown. &lt;b&gt;Obstacles&lt;/b&gt;: a polygon for each patch of cells of at least &lt;i&gt;OCCUPIED_FROM&lt;/i&gt;, along the edges of the cells.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Place&lt;/b&gt;: the map's metres are those of the site frame. &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt; say where that is; files of &lt;i&gt;Export navigation map&lt;/i&gt; say it themselves. Where neither does, the layers are in local metres, said in a warning.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importnavigationmap -- MAP=warehouse.yaml SITE_CRS=EPSG:32633 ORIGIN="640420,5193480 [EPSG:32633]" ROTATION=0 RASTER=warehouse.tif OBSTACLES=warehouse.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Llegeix un mapa de Nav2: el &lt;b&gt;YAML&lt;/b&gt; i la imatge que anomena (PGM, PNG, BMP o JPEG), en els modes &lt;i&gt;trinary&lt;/i&gt;, &lt;i&gt;scale&lt;/i&gt; i &lt;i&gt;raw&lt;/i&gt;, amb els seus llindars, &lt;i&gt;negate&lt;/i&gt; i l’origen amb el gir.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Ràster&lt;/b&gt;: un valor per a cada cel·la, de 0 lliure a 100 ocupada, -1 desconeguda. &lt;b&gt;Obstacles&lt;/b&gt;: un polígon per a cada clapa de cel·les d’almenys &lt;i&gt;OCCUPIED_FROM&lt;/i&gt;, al llarg de les vores de les cel·les.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Lloc&lt;/b&gt;: els metres del mapa són els del marc del recinte. &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; i &lt;i&gt;ROTATION&lt;/i&gt; diuen on és; els fitxers de &lt;i&gt;Exporta el mapa de navegació&lt;/i&gt; ho diuen ells mateixos. Si no ho diu ningú, les capes són en metres locals i un avís ho diu.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importnavigationmap -- MAP=warehouse.yaml SITE_CRS=EPSG:32633 ORIGIN="640420,5193480 [EPSG:32633]" ROTATION=0 RASTER=warehouse.tif OBSTACLES=warehouse.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Import navigation map</source>
            <translation>Importa un mapa de navegació</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Nav2 map (YAML)</source>
            <translation>Mapa de Nav2 (YAML)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Nav2 maps (*.yaml *.yml);;All files (*)</source>
            <translation>Mapes de Nav2 (*.yaml *.yml);;Tots els fitxers (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Occupied cells</source>
            <translation>Cel·les ocupades</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Occupied from [of 100]</source>
            <translation>Ocupada a partir de [de 100]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Raster</source>
            <translation>Ràster</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Reads a Nav2 occupancy grid or mask as raster, and polygons of what is occupied.</source>
            <translation>Llegeix una graella d’ocupació o una màscara de Nav2 com a ràster i polígons del que és ocupat.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The Nav2 map {file} cannot be read: {error}</source>
            <translation>No es pot llegir el mapa de Nav2 {file}: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The image {file} cannot be read as PGM, PNG, BMP or JPEG: {why}</source>
            <translation>No es pot llegir la imatge {file} com a PGM, PNG, BMP o JPEG: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The image {file} has no bands of 8 bits: save it as grey, without a palette.</source>
            <translation>La imatge {file} no té bandes de 8 bits: deseu-la en gris, sense paleta.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster</source>
            <translation>El ràster</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster {file} cannot be written: QGIS reads rasters of this kind, and writes none. Give it a name that ends in .tif.</source>
            <translation>El ràster {file} no es pot escriure: QGIS llegeix ràsters d'aquesta mena, i no n'escriu cap. Doneu-li un nom que acabi en .tif.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster {file} cannot be written: {why}</source>
            <translation>No es pot escriure el ràster {file}: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>There is no file {file}: choose the YAML of a Nav2 map (MAP).</source>
            <translation>No hi ha cap fitxer {file}: trieu el YAML d’un mapa de Nav2 (MAP).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>There is no image {file}, which the map names: put it there, or correct the YAML.</source>
            <translation>No hi ha la imatge {file}, que el mapa anomena: poseu-la-hi o corregiu el YAML.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Unknown cells</source>
            <translation>Cel·les desconegudes</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n centrelines</source>
            <translation>
                <numerusform>%n eix</numerusform>
                <numerusform>%n eixos</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n obstacle outlines</source>
            <translation>
                <numerusform>%n contorn d'obstacle</numerusform>
                <numerusform>%n contorns d'obstacles</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n road surfaces</source>
            <translation>
                <numerusform>%n superfície de via</numerusform>
                <numerusform>%n superfícies de via</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>&lt;p&gt;Writes the layers of a site into a folder with &lt;i&gt;site.toml&lt;/i&gt; and &lt;i&gt;site.gpkg&lt;/i&gt;, which &lt;i&gt;robot-bridge serve --site FOLDER&lt;/i&gt; serves.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Layers&lt;/b&gt;: those of the project by their roles (menu Fleet Supervisor, Layer roles), or by a &lt;b&gt;map profile&lt;/b&gt;, or the layers given here. Which features count, heights, where things begin above the ground, labels, road widths and shapes of furniture come from the expressions kept with the roles; heights, labels and widths else from the fields &lt;i&gt;height&lt;/i&gt; or &lt;i&gt;height_m&lt;/i&gt;, &lt;i&gt;surface&lt;/i&gt;, &lt;i&gt;name&lt;/i&gt;, &lt;i&gt;width_m&lt;/i&gt; or &lt;i&gt;width&lt;/i&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Version&lt;/b&gt;: 1 for a new folder, else one more than the version there. A folder that holds another site is refused unless &lt;b&gt;Replace&lt;/b&gt; is ticked.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Database&lt;/b&gt;: the site goes into PostgreSQL with PostGIS, too, or only there where no folder is given: the layers as tables, with views of the newest version in the schema &lt;i&gt;site_ID&lt;/i&gt;, and all that &lt;i&gt;robot-bridge serve --site postgresql://account@host/database#ID&lt;/i&gt; serves. It is a connection of QGIS's or such an address.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Bounds&lt;/b&gt;: the rectangle, along the axes of the site frame, that robots may be sent into. Obstacles are published up to 100 m beyond it, so that a robot at its edge is told what stands there.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Site CRS, origin, rotation&lt;/b&gt;: where the robots' (0, 0) is and how their x axis lies. Default: as the project has it.&lt;/p&gt; &lt;p&gt;An earlier publication is replaced only after the new one is complete; a cancel leaves it as it was. Broken geometry is repaired where that is safe and left out where it is not, each time with a warning that names the layer and the feature. One publication into a folder runs at a time.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Escriu les capes d'un recinte en una carpeta amb &lt;i&gt;site.toml&lt;/i&gt; i &lt;i&gt;site.gpkg&lt;/i&gt;, que serveix &lt;i&gt;robot-bridge serve --site FOLDER&lt;/i&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Capes&lt;/b&gt;: les del projecte segons els seus papers (menú Fleet Supervisor, Papers de les capes), o segons un &lt;b&gt;perfil de mapa&lt;/b&gt;, o les capes que es donen aquí. Quines entitats compten, les alçades, on comencen les coses sobre el terra, les etiquetes, les amplades de les vies i les formes del mobiliari venen de les expressions que es guarden amb els papers; les alçades, etiquetes i amplades si no dels camps &lt;i&gt;height&lt;/i&gt; o &lt;i&gt;height_m&lt;/i&gt;, &lt;i&gt;surface&lt;/i&gt;, &lt;i&gt;name&lt;/i&gt;, &lt;i&gt;width_m&lt;/i&gt; o &lt;i&gt;width&lt;/i&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Versió&lt;/b&gt;: 1 per a una carpeta nova, si no una més que la que hi ha. Una carpeta amb un altre recinte es refusa si no es marca &lt;b&gt;Substitueix&lt;/b&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Base de dades&lt;/b&gt;: el recinte va també a PostgreSQL amb PostGIS, o només allà si no es dona cap carpeta: les capes com a taules, amb vistes de la versió més nova a l'esquema &lt;i&gt;site_ID&lt;/i&gt;, i tot el que serveix &lt;i&gt;robot-bridge serve --site postgresql://account@host/database#ID&lt;/i&gt;. És una connexió del QGIS o una adreça com aquesta.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Límits&lt;/b&gt;: el rectangle, al llarg dels eixos del marc del recinte, on es poden enviar robots. Els obstacles es publiquen fins a 100 m més enllà, perquè un robot a la vora sàpiga què hi ha.&lt;/p&gt; &lt;p&gt;&lt;b&gt;SRC, origen i rotació del recinte&lt;/b&gt;: on és el (0, 0) dels robots i com està el seu eix x. Per defecte: com ho té el projecte.&lt;/p&gt; &lt;p&gt;Una publicació anterior només se substitueix quan la nova és completa; una cancel·lació la deixa com era. La geometria trencada es repara on és segur i queda fora on no ho és, cada vegada amb un avís que anomena la capa i l'entitat. Només es fa una publicació alhora en una carpeta.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Id of the site</source>
            <translation>Id del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Obstacle outlines</source>
            <translation>Contorns d'obstacles</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Publish site</source>
            <translation>Publica el recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Schema of the site's views in the database</source>
            <translation>Esquema de les vistes del recinte a la base de dades</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Site {id} version {version} is published in {folder}: {outlines}, {centrelines}, {surfaces}, {keepouts}; bounds {bounds} m</source>
            <translation>El recinte {id} versió {version} s'ha publicat a {folder}: {outlines}, {centrelines}, {surfaces}, {keepouts}; límits {bounds} m</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>The origin of the site frame is 0,0 of {crs}, {away:.0f} km from the site: robots get positions of seven digits. Give ORIGIN, a place of the site, unless that is meant.</source>
            <translation>L'origen del marc del recinte és 0,0 de {crs}, a {away:.0f} km del recinte: els robots reben posicions de set xifres. Indiqueu ORIGIN, un punt del recinte, si no és el que voleu.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>The tables in the schema {schema} of an earlier version are in use: they stay until the next publication.</source>
            <translation>Les taules d'una versió anterior a l'esquema {schema} són en ús: s'hi queden fins a la publicació següent.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>There is nothing to publish: the layers hold nothing that can be read. See the warnings, or give BOUNDS to publish an empty site.</source>
            <translation>No hi ha res a publicar: les capes no contenen res que es pugui llegir. Vegeu els avisos, o doneu BOUNDS per publicar un recinte buit.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Version of the site</source>
            <translation>Versió del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Writes the layers of a site, by their roles, into the folder that a gateway serves.</source>
            <translation>Escriu les capes d'un recinte, segons els seus papers, a la carpeta que serveix una passarel·la.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>the database, schema {schema}</source>
            <translation>la base de dades, esquema {schema}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>&lt;p&gt;Checks a robot map, text or binary, and makes a layer of lines that show what is odd, each with a kind, a severity, the obstacle to look at, and what to do.&lt;/p&gt; &lt;p&gt;&lt;b&gt;orientation&lt;/b&gt;: outlines, courtyards, segments or risers that run the wrong way round. &lt;b&gt;gap&lt;/b&gt;: rings that do not close, and lines that stop just short of another obstacle. &lt;b&gt;sliver&lt;/b&gt;: rings next to nothing wide, segments without length. &lt;b&gt;duplicate&lt;/b&gt;, &lt;b&gt;overlap&lt;/b&gt;: obstacles that repeat, cross or cover one another or lie inside another. &lt;b&gt;shared wall&lt;/b&gt;: where two outlines touch back to back. &lt;b&gt;pocket&lt;/b&gt;: free space that a robot of the given width cannot reach; courtyards are such pockets. &lt;b&gt;height&lt;/b&gt;: heights of 0 or less, or above 0 where there must be none. &lt;b&gt;outside&lt;/b&gt;: segments beyond the border. &lt;b&gt;id&lt;/b&gt;: ids used twice.&lt;/p&gt; &lt;p&gt;Severities: &lt;i&gt;error&lt;/i&gt; misleads a robot, &lt;i&gt;warning&lt;/i&gt; is probably not meant, &lt;i&gt;info&lt;/i&gt; is worth knowing. The map itself is not changed.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Comprova un mapa de robots, de text o binari, i fa una capa de línies que mostren què és estrany, cadascuna amb un tipus, una gravetat, l'obstacle que cal mirar i què cal fer.&lt;/p&gt; &lt;p&gt;&lt;b&gt;orientation&lt;/b&gt;: contorns, patis, segments o graons que van en el sentit equivocat. &lt;b&gt;gap&lt;/b&gt;: anells que no es tanquen, i línies que s'aturen just abans d'un altre obstacle. &lt;b&gt;sliver&lt;/b&gt;: anells gairebé sense amplada, segments sense longitud. &lt;b&gt;duplicate&lt;/b&gt;, &lt;b&gt;overlap&lt;/b&gt;: obstacles que es repeteixen, s'encreuen o es cobreixen, o són dins d'un altre. &lt;b&gt;shared wall&lt;/b&gt;: on dos contorns es toquen d'esquena. &lt;b&gt;pocket&lt;/b&gt;: espai lliure on no pot arribar un robot de l'amplada donada; els patis en són. &lt;b&gt;height&lt;/b&gt;: alçades de 0 o menys, o superiors a 0 on no n'hi pot haver. &lt;b&gt;outside&lt;/b&gt;: segments més enllà de la vora. &lt;b&gt;id&lt;/b&gt;: identificadors fets servir dues vegades.&lt;/p&gt; &lt;p&gt;Gravetats: &lt;i&gt;error&lt;/i&gt; enganya un robot, &lt;i&gt;warning&lt;/i&gt; probablement no és volgut, &lt;i&gt;info&lt;/i&gt; val la pena saber-ho. El mapa mateix no es canvia.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>&lt;p&gt;Reads a robot map, text or binary, and makes layers of it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Obstacles that are areas&lt;/b&gt;: outlines that close, courtyards as holes. &lt;b&gt;Obstacles that are lines&lt;/b&gt;: walls, stairs, and what the border of the map cuts. &lt;b&gt;Segments&lt;/b&gt;: each from a to b, with free space on its right; the style shows that side by ticks and the height by colour. Fields: id, shape, labels, height, indoors or outdoors, extras (&lt;i&gt;ext&lt;/i&gt;, as JSON).&lt;/p&gt; &lt;p&gt;&lt;b&gt;Place&lt;/b&gt;: a map may name its CRS, origin and rotation in its leading lines; parameters win over them. Where neither does, the layers are in local metres, said in a warning.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Llegeix un mapa de robots, de text o binari, i en fa capes.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Obstacles que són àrees&lt;/b&gt;: contorns que es tanquen, amb els patis com a forats. &lt;b&gt;Obstacles que són línies&lt;/b&gt;: parets, escales, i el que talla la vora del mapa. &lt;b&gt;Segments&lt;/b&gt;: cadascun de a a b, amb espai lliure a la dreta; l'estil mostra aquest costat amb ratlletes i l'alçada amb el color. Camps: identificador, forma, etiquetes, alçada, interior o exterior, extres (&lt;i&gt;ext&lt;/i&gt;, com a JSON).&lt;/p&gt; &lt;p&gt;&lt;b&gt;Lloc&lt;/b&gt;: un mapa pot dir el seu SRC, l'origen i la rotació a les línies inicials; els paràmetres passen per davant. On no ho diu cap, les capes són en metres locals, amb un avís.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Border of the map</source>
            <translation>Límit del mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Check robot map</source>
            <translation>Comprova el mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Errors</source>
            <translation>Errors</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Findings</source>
            <translation>Troballes</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Finds turned outlines, gaps, slivers, repeats, overlaps and unreachable pockets in a robot map.</source>
            <translation>Troba contorns girats, forats, estelles, repeticions, encavalcaments i racons inaccessibles en un mapa de robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Load robot map</source>
            <translation>Carrega un mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Longest gap that was not meant [m]</source>
            <translation>Forat més llarg que no és volgut [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Narrowest ring that is an obstacle [m]</source>
            <translation>Anell més estret que és un obstacle [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Nothing is odd in this map.</source>
            <translation>No hi ha res estrany en aquest mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Obstacles that are areas</source>
            <translation>Obstacles que són àrees</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Obstacles that are lines</source>
            <translation>Obstacles que són línies</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Smallest unreachable pocket [m²]</source>
            <translation>Racó inaccessible més petit [m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Turns a robot map, text or binary, into layers with all that the map says.</source>
            <translation>Converteix un mapa de robots, text o binari, en capes amb tot el que diu el mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Width of the robot, for unreachable pockets [m]</source>
            <translation>Amplada del robot, per als racons inaccessibles [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Worth knowing</source>
            <translation>Val la pena saber-ho</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n nodes</source>
            <translation>
                <numerusform>%n node</numerusform>
                <numerusform>%n nodes</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n parts</source>
            <translation>
                <numerusform>%n part</numerusform>
                <numerusform>%n parts</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n points</source>
            <translation>
                <numerusform>%n punt</numerusform>
                <numerusform>%n punts</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n repairs</source>
            <translation>
                <numerusform>%n reparació</numerusform>
                <numerusform>%n reparacions</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Checks the network that road centrelines make, and makes a layer of points that show what is odd, each with the feature to look at. Nothing is changed.&lt;/p&gt; &lt;p&gt;What &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; repairs: &lt;b&gt;gap&lt;/b&gt;, an end that stops within the tolerance of another road; &lt;b&gt;overshoot&lt;/b&gt;, an end that reaches beyond a road by less than that; &lt;b&gt;duplicate&lt;/b&gt;, a stretch that is drawn twice.&lt;/p&gt; &lt;p&gt;What only people can judge: &lt;b&gt;dead end&lt;/b&gt;; &lt;b&gt;disconnected part&lt;/b&gt;, roads that are connected with one another but not with the longest part; &lt;b&gt;one-way&lt;/b&gt;, roads from which no way leads back because of the directions.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Comprova la xarxa que fan els eixos de via, i fa una capa de punts que mostren què és estrany, cadascun amb l'entitat que cal mirar. No es canvia res.&lt;/p&gt; &lt;p&gt;El que repara &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt;: &lt;b&gt;buit&lt;/b&gt; (gap), un extrem que s'atura dins de la tolerància d'una altra via; &lt;b&gt;excés&lt;/b&gt; (overshoot), un extrem que sobrepassa una via per menys que això; &lt;b&gt;duplicat&lt;/b&gt; (duplicate), un tram dibuixat dues vegades.&lt;/p&gt; &lt;p&gt;El que només poden jutjar les persones: &lt;b&gt;atzucac&lt;/b&gt; (dead end); &lt;b&gt;part desconnectada&lt;/b&gt; (disconnected part), vies connectades entre elles però no amb la part més llarga; &lt;b&gt;sentit únic&lt;/b&gt; (one-way), vies de les quals no es pot tornar a causa dels sentits.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Finds the way between two places near roads: each is taken to the nearest point of a road that may be used. Closed roads are not used, one-way roads in their direction only; &lt;b&gt;surfaces&lt;/b&gt; (names with commas between) and a &lt;b&gt;least width&lt;/b&gt; restrict the way further.&lt;/p&gt; &lt;p&gt;Edges that lead through a polygon of the &lt;b&gt;areas that must not be driven through&lt;/b&gt; are closed; what runs along a rim is not.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Route&lt;/b&gt; has a line for each stretch of road, in order. &lt;b&gt;Path&lt;/b&gt; is what a robot drives: points at most so far apart, corners rounded to the turning radius as far as robot and road are wide. Corners that stay tighter are counted and named in the log.&lt;/p&gt; &lt;p&gt;The &lt;b&gt;engine&lt;/b&gt; is RoutingKit or SciPy where Python has them, else QGIS's own; the log and &lt;i&gt;ENGINE_USED&lt;/i&gt; say which was used. All find the same ways.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:route -- ROADS=roads.gpkg START="640430,5193530 [EPSG:32633]" GOAL="640600,5193570 [EPSG:32633]" SURFACES=asphalt ROUTE=route.gpkg PATH=path.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Troba el camí entre dos llocs a prop de vies: cadascun es porta al punt més proper d'una via que es pot fer servir. Les vies tancades no es fan servir, les de sentit únic només en el seu sentit; les &lt;b&gt;superfícies&lt;/b&gt; (noms separats per comes) i una &lt;b&gt;amplada mínima&lt;/b&gt; restringeixen més el camí.&lt;/p&gt; &lt;p&gt;Les arestes que passen per un polígon de les &lt;b&gt;àrees per on no s'ha de circular&lt;/b&gt; són tancades; el que va per una vora no.&lt;/p&gt; &lt;p&gt;La &lt;b&gt;ruta&lt;/b&gt; té una línia per a cada tram de via, per ordre. El &lt;b&gt;camí&lt;/b&gt; és el que recorre un robot: punts separats com a màxim aquesta distància, cantonades arrodonides al radi de gir fins on ho permeten les amplades del robot i de la via. Les cantonades que queden més tancades es compten i s'anomenen al registre.&lt;/p&gt; &lt;p&gt;El &lt;b&gt;motor&lt;/b&gt; és RoutingKit o SciPy si el Python els té, si no el del QGIS; el registre i &lt;i&gt;ENGINE_USED&lt;/i&gt; diuen quin s'ha fet servir. Tots troben els mateixos camins.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:route -- ROADS=roads.gpkg START="640430,5193530 [EPSG:32633]" GOAL="640600,5193570 [EPSG:32633]" SURFACES=asphalt ROUTE=route.gpkg PATH=path.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Splits road centrelines where they cross or touch, and makes a layer of edges and one of nodes.&lt;/p&gt; &lt;p&gt;Roads of different &lt;b&gt;levels&lt;/b&gt; meet only where one of them ends in a point of the other: a bridge is reached at its ends and passes over what is between them. &lt;b&gt;Direction&lt;/b&gt;, speed, width, surface and whether a road is closed go over to its edges.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Repair&lt;/b&gt; moves ends that stop within the tolerance of a road onto it, cuts off ends that reach beyond a road by less, and leaves out what is drawn twice; the log names each repair. &lt;i&gt;fleet:checkroadnetwork&lt;/i&gt; shows what is broken without changing anything.&lt;/p&gt; &lt;p&gt;The fields of the edges are those that this algorithm and &lt;i&gt;fleet:route&lt;/i&gt; read by themselves. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Talla els eixos de via on s'encreuen o es toquen, i fa una capa d'arestes i una de nodes.&lt;/p&gt; &lt;p&gt;Les vies de &lt;b&gt;nivells&lt;/b&gt; diferents només es troben on una d'elles acaba en un punt de l'altra: a un pont s'hi entra pels extrems i passa per sobre del que hi ha entremig. El &lt;b&gt;sentit&lt;/b&gt;, la velocitat, l'amplada, la superfície i si una via és tancada passen a les seves arestes.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Reparar&lt;/b&gt; porta fins a una via els extrems que s'hi aturen dins de la tolerància, talla els que la sobrepassen per menys, i deixa fora el que és dibuixat dues vegades; el registre anomena cada reparació. &lt;i&gt;fleet:checkroadnetwork&lt;/i&gt; mostra què està trencat sense canviar res.&lt;/p&gt; &lt;p&gt;Els camps de les arestes són els que aquest algorisme i &lt;i&gt;fleet:route&lt;/i&gt; llegeixen sols. docs/roads.md en diu més.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Build road network</source>
            <translation>Construeix la xarxa de vies</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Check road network</source>
            <translation>Comprova la xarxa de vies</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Corners tighter than the robot turns</source>
            <translation>Cantonades més tancades que el gir del robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Dead ends</source>
            <translation>Carrerons sense sortida</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Edges without a way back</source>
            <translation>Arestes sense camí de tornada</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Engine</source>
            <translation>Motor</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Engine that was used</source>
            <translation>Motor utilitzat</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Finds gaps, overshoots, duplicates, dead ends, separate parts and one-way traps in road centrelines.</source>
            <translation>Troba forats, sobrepassaments, duplicats, carrerons sense sortida, parts separades i trampes de sentit únic als eixos de via.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Finds the shortest or fastest way along road centrelines, and the path that a robot drives.</source>
            <translation>Troba el recorregut més curt o més ràpid pels eixos de via, i el camí que fa un robot.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Gaps</source>
            <translation>Forats</translation>
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
            <translation>Nodes</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Nothing is odd in this network.</source>
            <translation>No hi ha res estrany en aquesta xarxa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Overshoots</source>
            <translation>Sobrepassaments</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Parts of their own</source>
            <translation>Parts separades</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Parts that are not connected</source>
            <translation>Parts no connectades</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Path</source>
            <translation>Camí</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Points of the path</source>
            <translation>Punts del camí</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Repairs</source>
            <translation>Reparacions</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Roads drawn twice</source>
            <translation>Vies dibuixades dues vegades</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Route</source>
            <translation>Ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Route on roads</source>
            <translation>Ruta per vies</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Splits road centrelines where they meet, passes over and under at bridges, and repairs on request.</source>
            <translation>Divideix els eixos de via on es troben, passa per sobre i per sota als ponts, i repara si es demana.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Start</source>
            <translation>Inici</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>The corner at ({x:.2f}, {y:.2f}) is tighter than the robot turns.</source>
            <translation>La cantonada a ({x:.2f}, {y:.2f}) és més tancada que el gir del robot.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Time on the route [s]</source>
            <translation>Temps de la ruta [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>fastest</source>
            <translation>la més ràpida</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>none: plain Python</source>
            <translation>cap: només Python</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>shortest</source>
            <translation>la més curta</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>the fastest that is installed</source>
            <translation>el més ràpid dels instal·lats</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>{metres:.1f} m, {seconds:.1f} s, {points}, found by {engine}; start {off_start:.2f} m and goal {off_goal:.2f} m from the road</source>
            <translation>{metres:.1f} m, {seconds:.1f} s, {points}, trobada per {engine}; inici a {off_start:.2f} m i final a {off_goal:.2f} m de la via</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>%n of the surfaces that are given as drawn say that they were generated (field origin); they are left out and made anew</source>
            <translation>
                <numerusform>%n de les superfícies donades com a dibuixades diu que es va generar (camp origin); s'omet i es torna a fer</numerusform>
                <numerusform>%n de les superfícies donades com a dibuixades diuen que es van generar (camp origin); s'ometen i es tornen a fer</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>%n points are on a surface, {off} on none.</source>
            <translation>
                <numerusform>%n punt és sobre una superfície, {off} sobre cap.</numerusform>
                <numerusform>%n punts són sobre una superfície, {off} sobre cap.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>&lt;p&gt;Copies points and adds &lt;b&gt;surface&lt;/b&gt;, the class of the road surface that each is on, its &lt;b&gt;surface_name&lt;/b&gt;, and &lt;b&gt;surface_origin&lt;/b&gt;: whether the surface was drawn or generated from centrelines. They are empty where there is no surface.&lt;/p&gt; &lt;p&gt;The surfaces are layers of areas with a field &lt;i&gt;surface&lt;/i&gt;, or the class that their role says; without any, the project's layers with the role road surface. Points and layers may be in any CRS.&lt;/p&gt; &lt;p&gt;A point on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a generated one, then the smaller before the larger. The expression &lt;i&gt;road_surface(x, y)&lt;/i&gt; tells the same. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Copia punts i hi afegeix &lt;b&gt;surface&lt;/b&gt;, la classe de la superfície de via on és cadascun, el seu &lt;b&gt;surface_name&lt;/b&gt;, i &lt;b&gt;surface_origin&lt;/b&gt;: si la superfície és dibuixada o generada dels eixos. Són buits on no hi ha superfície.&lt;/p&gt; &lt;p&gt;Les superfícies són capes d'àrees amb un camp &lt;i&gt;surface&lt;/i&gt;, o la classe que diu el seu paper; si no se'n dona cap, les capes del projecte amb el paper de superfície de via. Els punts i les capes poden ser en qualsevol SRC.&lt;/p&gt; &lt;p&gt;Un punt a la vora és a la superfície. On les superfícies se superposen compta abans una de dibuixada que una de generada, i després la més petita abans que la més gran. L'expressió &lt;i&gt;road_surface(x, y)&lt;/i&gt; diu el mateix. docs/roads.md en diu més.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>&lt;p&gt;Widens road centrelines by half their width to each side: ends are cut square, corners are mitred, within a road and where roads end in one point. What is of one class, such as asphalt, becomes one surface; pieces that do not touch are features of their own.&lt;/p&gt; &lt;p&gt;No ground is in two surfaces. Surfaces &lt;b&gt;drawn by hand&lt;/b&gt; keep theirs and are copied to the result. Among generated ones the class that comes first in &lt;b&gt;precedence&lt;/b&gt; keeps the ground; of classes that are not named there the one with less ground, and what has no class comes last.&lt;/p&gt; &lt;p&gt;A road whose width is not known is as wide as &lt;b&gt;default width&lt;/b&gt; says, and is in the layer of &lt;b&gt;findings&lt;/b&gt;. Ends that stop just short of another road stay apart: mend them with &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; and give its edges.&lt;/p&gt; &lt;p&gt;Give the result the role road surface to publish it. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Eixampla els eixos de via la meitat de la seva amplada a cada banda: els extrems es tallen rectes i les cantonades es fan en punta, dins d'una via i on diverses vies acaben en un punt. El que és d'una classe, com ara asfalt, esdevé una superfície; els trossos que no es toquen són entitats pròpies.&lt;/p&gt; &lt;p&gt;Cap terreny no és en dues superfícies. Les &lt;b&gt;dibuixades a mà&lt;/b&gt; conserven el seu i es copien al resultat. Entre les generades conserva el terreny la classe que va primer a la &lt;b&gt;precedència&lt;/b&gt;; de les que no hi són anomenades, la que té menys terreny, i el que no té classe va l'últim.&lt;/p&gt; &lt;p&gt;Una via d'amplada desconeguda és tan ampla com diu l'&lt;b&gt;amplada per defecte&lt;/b&gt;, i surt a la capa de &lt;b&gt;troballes&lt;/b&gt;. Els extrems que s'aturen just abans d'una altra via queden separats: arregleu-los amb &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; i doneu-ne les arestes.&lt;/p&gt; &lt;p&gt;Doneu al resultat el paper de superfície de via per publicar-lo. docs/roads.md en diu més.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Adds to points, in any CRS, the class of the road surface that they are on.</source>
            <translation>Afegeix a punts, en qualsevol SRC, la classe de la superfície de via on són.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Area [m²]</source>
            <translation>Àrea [m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Build road surfaces</source>
            <translation>Construeix les superfícies de via</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Classes that keep their ground, the first before the second</source>
            <translation>Classes que conserven el seu sòl, la primera abans que la segona</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Feature {id} has points on several surfaces; none is given for it</source>
            <translation>L'entitat {id} té punts sobre diverses superfícies; no se'n dona cap</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Generated ones</source>
            <translation>Generades</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>No road surfaces are given, and no layer of the project has the role road surface: give SURFACES, or set the role in Plugins &gt; Fleet Supervisor &gt; Layer roles.</source>
            <translation>No s'han donat superfícies de via, i cap capa del projecte té el paper superfície de via: doneu SURFACES, o poseu el paper a Connectors &gt; Fleet Supervisor &gt; Papers de les capes.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>POINTS {name} is a table without places: make points of its columns first, by native:createpointslayerfromtable.</source>
            <translation>POINTS {name} és una taula sense llocs: feu primer punts de les seves columnes amb native:createpointslayerfromtable.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points</source>
            <translation>Punts</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points on a surface</source>
            <translation>Punts sobre una superfície</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points on none</source>
            <translation>Punts sobre cap</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points with surface</source>
            <translation>Punts amb superfície</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Road surfaces (default: the project's layers with that role)</source>
            <translation>Superfícies de via (per defecte: les capes del projecte amb aquest paper)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Roads without a width</source>
            <translation>Vies sense amplada</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Surface at point</source>
            <translation>Superfície al punt</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Surfaces drawn by hand, which keep their ground</source>
            <translation>Superfícies dibuixades a mà, que conserven el seu terreny</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>The width of this road is not known; {width:g} m is used.</source>
            <translation>L'amplada d'aquesta via no es coneix; s'hi posa {width:g} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Widens centrelines to surfaces, one for each class; surfaces drawn by hand keep their ground.</source>
            <translation>Eixampla els eixos en superfícies, una per classe; les dibuixades a mà conserven el seu terreny.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>without a class</source>
            <translation>sense classe</translation>
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
                <numerusform>%n entitat no té lloc, robot o temps; queda fora.</numerusform>
                <numerusform>%n entitats no tenen lloc, robot o temps; queden fora.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n lines</source>
            <translation>
                <numerusform>%n línia</numerusform>
                <numerusform>%n línies</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n positions</source>
            <translation>
                <numerusform>%n posició</numerusform>
                <numerusform>%n posicions</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n values of the field {name} are no numbers, and count as no speed.</source>
            <translation>
                <numerusform>%n valor del camp {name} no és un número, i no compta com a velocitat.</numerusform>
                <numerusform>%n valors del camp {name} no són números, i no compten com a velocitat.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>&lt;p&gt;Makes of the positions that a gateway stored one line for each drive of each robot: a robot that was not heard of for longer than the gap begins a new line. Or, with &lt;b&gt;a line for each step&lt;/b&gt;, one for each pair of positions, for colours by speed and for QGIS's temporal controller.&lt;/p&gt; &lt;p&gt;The positions are the layer &lt;i&gt;positions&lt;/i&gt; of &lt;i&gt;robot-bridge trajectories export drives.gpkg --site site&lt;/i&gt;, or any points, in any CRS, with a field for the robot and one for the time (date and time, seconds since 1970, or ISO 8601; without an offset UTC).&lt;/p&gt; &lt;p&gt;Fields: &lt;b&gt;begin&lt;/b&gt; and &lt;b&gt;end&lt;/b&gt; (UTC), &lt;b&gt;duration_s&lt;/b&gt;, &lt;b&gt;length_m&lt;/b&gt;, &lt;b&gt;mean_speed&lt;/b&gt; and &lt;b&gt;top_speed&lt;/b&gt; in m/s (as the robot told it, else its fastest step), &lt;b&gt;count&lt;/b&gt; of positions. The measure M of each vertex is its time in seconds since 1970. Lengths are measured in the layer's CRS if that is in true metres, as robots drive them, else on its ellipsoid.&lt;/p&gt; &lt;p&gt;The layer's times are set: open QGIS's temporal controller to play them.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:trajectories -- INPUT="drives.gpkg|layername=positions" OUTPUT=lines.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Fa de les posicions que ha desat una passarel·la una línia per a cada trajecte de cada robot: un robot de qui no s'ha sabut res durant més que el buit comença una línia nova. O, amb &lt;b&gt;una línia per a cada pas&lt;/b&gt;, una per a cada parella de posicions, per pintar-les segons la velocitat i per al controlador temporal del QGIS.&lt;/p&gt; &lt;p&gt;Les posicions són la capa &lt;i&gt;positions&lt;/i&gt; de &lt;i&gt;robot-bridge trajectories export drives.gpkg --site site&lt;/i&gt;, o qualssevol punts, en qualsevol SRC, amb un camp per al robot i un per al temps (data i hora, segons des de 1970, o ISO 8601; sense desfasament UTC).&lt;/p&gt; &lt;p&gt;Camps: &lt;b&gt;begin&lt;/b&gt; i &lt;b&gt;end&lt;/b&gt; (UTC), &lt;b&gt;duration_s&lt;/b&gt;, &lt;b&gt;length_m&lt;/b&gt;, &lt;b&gt;mean_speed&lt;/b&gt; i &lt;b&gt;top_speed&lt;/b&gt; en m/s (com ho ha dit el robot, si no el seu pas més ràpid), &lt;b&gt;count&lt;/b&gt; de posicions. La mesura M de cada vèrtex és el seu temps en segons des de 1970. Les longituds es mesuren al SRC de la capa si és en metres de debò, com les recorren els robots, si no sobre el seu el·lipsoide.&lt;/p&gt; &lt;p&gt;Els temps de la capa estan posats: obriu el controlador temporal del QGIS per reproduir-los.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:trajectories -- INPUT="drives.gpkg|layername=positions" OUTPUT=lines.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>A line for each step</source>
            <translation>Una línia per a cada pas</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the robot</source>
            <translation>Camp del robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the speed [m/s]</source>
            <translation>Camp de la velocitat [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the time</source>
            <translation>Camp del temps</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Lines</source>
            <translation>Línies</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Longest gap in a line [s]</source>
            <translation>Buit més llarg en una línia [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Makes lines of stored positions, with their time, length and speed.</source>
            <translation>Fa línies de les posicions desades, amb el seu temps, longitud i velocitat.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Metres driven, all robots</source>
            <translation>Metres recorreguts, tots els robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Positions</source>
            <translation>Posicions</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>The positions have no field {name} for the {what}: they have {names}. Give the layer 'positions' of 'robot-bridge trajectories export', or say which field it is.</source>
            <translation>Les posicions no tenen el camp {name} per a: {what}; tenen {names}. Doneu la capa 'positions' de 'robot-bridge trajectories export', o digueu quin camp és.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Trajectories</source>
            <translation>Trajectòries</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>robot</source>
            <translation>robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>time</source>
            <translation>temps</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>{lines} of {positions}, {length:.1f} m in all.</source>
            <translation>{lines} de {positions}, {length:.1f} m en total.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>'x,y', or 'x,y [EPSG:4326]' in another CRS</source>
            <translation>'x,y', o 'x,y [EPSG:4326]' en un altre SRC</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>'xmin,xmax,ymin,ymax'</source>
            <translation>'xmin,xmax,ymin,ymax'</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>It was cancelled before its end.</source>
            <translation>S'ha cancel·lat abans d'acabar.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>Robot maps</source>
            <translation>Mapes de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>There is no parameter {name}: correct it or leave it out. There are: {names}.</source>
            <translation>No hi ha cap paràmetre {name}: corregiu-lo o ometeu-lo. N'hi ha: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>a number</source>
            <translation>un nombre</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>one of {options}</source>
            <translation>un d'aquests: {options}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>true or false</source>
            <translation>true o false</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name} is {value}: give {wanted}.</source>
            <translation>{name} és {value}: doneu {wanted}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name}: the file {file} holds {count} layers ({layers}): say which, as in {file}|layername={first}.</source>
            <translation>{name}: el fitxer {file} conté {count} capes ({layers}): digueu quina, com a {file}|layername={first}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name}: the layer {layer} cannot be opened: check the file, and the layer's name after '|layername='.</source>
            <translation>{name}: la capa {layer} no es pot obrir: comproveu el fitxer i el nom de la capa després de '|layername='.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Classes of surface that are allowed, such as asphalt (default: all)</source>
            <translation>Classes de superfície permeses, com ara asphalt (per defecte: totes)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Distance between cones [m]</source>
            <translation>Distància entre cons [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Distance to obstacles [m]</source>
            <translation>Distància als obstacles [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Layer {name}: {note}</source>
            <translation>Capa {name}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>No layer of surfaces is given: whether the cones stand on the road is not checked.</source>
            <translation>No s'ha donat cap capa de superfícies: no es comprova si els cons són a la via.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>No surface is of class {classes}: the layers have {classes_there}.</source>
            <translation>No hi ha cap superfície de classe {classes}: les capes tenen {classes_there}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Nothing is wrong with the places of the cones.</source>
            <translation>No hi ha res incorrecte en els llocs dels cons.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Obstacles to keep away from</source>
            <translation>Obstacles dels quals cal allunyar-se</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Site CRS, in metres (default: the project's, else the line's or the layer's)</source>
            <translation>SRC del recinte, en metres (per defecte: el del projecte, si no el de la línia o la capa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Surfaces to stand on (default: not checked)</source>
            <translation>Superfícies on han d'estar (per defecte: no es comprova)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>The CRS of the site is not known: give SITE_CRS, such as EPSG:32633.</source>
            <translation>El SRC del recinte no es coneix: doneu SITE_CRS, com ara EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>There are no findings: their layer is empty, and is not loaded.</source>
            <translation>No hi ha cap troballa: la seva capa és buida i no es carrega.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}, feature {id}</source>
            <translation>{layer}, entitat {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}: {field} is {value!r}, which is no number; correct it.</source>
            <translation>{layer}: {field} és {value!r}, que no és un nombre; corregiu-lo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}: {field} is {value:g}; give a whole number.</source>
            <translation>{layer}: {field} és {value:g}; doneu un nombre enter.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{name}, feature {id}</source>
            <translation>{name}, entitat {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{where} is not one point with a place on the site: correct or delete it.</source>
            <translation>{where} no és un sol punt amb lloc al recinte: corregiu-lo o esborreu-lo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. An outline that would cross itself stays as it is. Needs the Python package shapely 2.</source>
            <translation>0: desactivat. Un contorn que es creuaria a si mateix es queda com és. Necessita el paquet de Python shapely 2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. Ends of lines stay and rings keep three corners. Needs the Python package shapely 2.</source>
            <translation>0: desactivat. Els extrems de les línies es queden i els anells conserven tres cantonades. Necessita el paquet de Python shapely 2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. Half a metre makes a compact map smaller still, and no obstacle lower than it is.</source>
            <translation>0: desactivat. Mig metre fa encara més petit un mapa compacte, i cap obstacle més baix del que és.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>A whole map lies inside of {sources} and has no wall of it: maps hold walls alone, and do not say that a robot is in there. Choose a larger window or larger tiles.</source>
            <translation>Un mapa sencer és dins de {sources} i no en té cap paret: els mapes només contenen parets i no diuen que un robot és a dins. Trieu una finestra més gran o tessel·les més grans.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Bare map: no leading lines, no extras</source>
            <translation>Mapa nu: sense línies inicials ni extres</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>DEFAULT_HEIGHT is {height}: give a number of metres of 0 or more.</source>
            <translation>DEFAULT_HEIGHT és {height}: doneu un nombre de metres de 0 o més.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>DISSOLVE, TOLERANCE and SHORTEST need the Python package shapely 2, and {version} is installed here: install a newer one (python3 -m pip install 'shapely&gt;=2'), or leave them off.</source>
            <translation>DISSOLVE, TOLERANCE i SHORTEST necessiten el paquet de Python shapely 2, i aquí hi ha {version}: instal·leu-ne un de més nou (python3 -m pip install 'shapely&gt;=2'), o deixeu-los desactivats.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Fewer corners: how far an outline may then be from the drawn one [m]</source>
            <translation>Menys cantonades: a quina distància pot quedar un contorn del dibuixat [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Format (compact: binary in columns, about a third of binary)</source>
            <translation>Format (compact: binari en columnes, un terç del binari)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Heights are rounded up to a multiple of this [m]</source>
            <translation>Alçades arrodonides a un múltiple de [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Join lines that meet end to end into one obstacle</source>
            <translation>Uneix en un obstacle les línies que es troben</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Leave out walls that no robot outside can meet</source>
            <translation>Omet els murs que cap robot pot trobar des de fora</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>No obstacle layer is given, and no layer of the project has a role of obstacles. Give OBSTACLES, roles (Fleet Supervisor &gt; Layer roles), or a PROFILE.</source>
            <translation>No s'ha indicat cap capa d'obstacles, i cap capa del projecte té un paper d'obstacle. Indiqueu OBSTACLES, papers (Fleet Supervisor &gt; Layer roles) o un PROFILE.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>OUTPUT {target} is the file of the layer {layer}: choose another one.</source>
            <translation>OUTPUT {target} és el fitxer de la capa {layer}: trieu-ne un altre.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Obstacle layers (default: those of the project with such a role)</source>
            <translation>Capes d'obstacles (per defecte: les del projecte amb aquest paper)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Only lines that are alike in height, label and all else. The source of a joined line is that of its first part and how many others are in it, such as walls:3+7.</source>
            <translation>Només línies iguals en alçada, etiqueta i tota la resta. La font d'una línia unida és la de la primera part i quantes més hi ha, com ara walls:3+7.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>PLANE_LOW is {low:g} and PLANE_HIGH {high:g}: give the lower and the upper height in metres.</source>
            <translation>PLANE_LOW és {low:g} i PLANE_HIGH {high:g}: doneu l'alçada inferior i la superior en metres.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Reducing obstacles</source>
            <translation>S'estan reduint els obstacles</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Robot's plane from [m above the ground]</source>
            <translation>Pla del robot des de [m sobre el sòl]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Robot's plane up to [m above the ground]</source>
            <translation>Pla del robot fins a [m sobre el sòl]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Shortest segment: corners nearer than this to the one before are left out [m]</source>
            <translation>Segment més curt: s'ometen les cantonades més properes a l'anterior [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>The layer {layer} is no vector layer: leave it out.</source>
            <translation>La capa {layer} no és vectorial: ometeu-la.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>The robot map</source>
            <translation>El mapa de robots</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Those between buildings that touch, and lines inside or along buildings. What stays keeps its height and its source. Needs the Python package shapely 2.</source>
            <translation>Els d'entre edificis que es toquen i les línies dins o al llarg d'edificis. El que queda conserva l'alçada i l'origen. Necessita el paquet de Python shapely 2.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>What begins at this height or above it is left out: the robot drives under it. Where things begin is said by the layers or by the parameter BASE_EXPRESSION.</source>
            <translation>El que comença a aquesta alçada o per sobre s'omet: el robot hi passa per sota. On comencen les coses ho diuen les capes o el paràmetre BASE_EXPRESSION.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>What is not higher than this is left out: the robot drives over it. Stairs and ramps stay. Give the lower and the upper height together, or neither.</source>
            <translation>El que no és més alt s'omet: el robot hi passa per sobre. Escales i rampes es queden. Doneu l'alçada inferior i la superior juntes, o cap.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>binary: the text compressed</source>
            <translation>binari: el text comprimit</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>compact: binary in columns</source>
            <translation>compacte: binari en columnes</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>text</source>
            <translation>text</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>text: lines that people and scripts read. binary: that text compressed, with a check sum. compact: the same map in columns of centimetres, also with a check sum (codec 2).</source>
            <translation>text: línies que llegeixen persones i scripts. binary: aquest text comprimit, amb suma de verificació. compact: el mateix mapa en columnes de centímetres, també amb suma de verificació (còdec 2).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{before} became {after}</source>
            <translation>abans: {before}; després: {after}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{name} is {value:g}: give a number of metres of 0 or more.</source>
            <translation>{name} és {value:g}: doneu un nombre de metres de 0 o més.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{other} is given and {missing} is not: give both heights in metres, or none.</source>
            <translation>S'ha donat {other} i no {missing}: doneu les dues alçades en metres, o cap.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>GeoJSON needs longitudes and latitudes, and the map's place is not known: give SITE_CRS, ORIGIN and ROTATION, or choose geopackage, which keeps the site's metres.</source>
            <translation>GeoJSON necessita longituds i latituds, i el lloc del mapa no es coneix: doneu SITE_CRS, ORIGIN i ROTATION, o trieu geopackage, que conserva els metres del recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>ORIGIN {origin} or ROTATION {rotation} is not finite: give numbers.</source>
            <translation>ORIGIN {origin} o ROTATION {rotation} no és finit: doneu nombres.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Origin of the site frame in it (default: as the map says, else 0,0)</source>
            <translation>Origen del marc del recinte en ell (per defecte: el que diu el mapa, si no 0,0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Robot map, text or binary</source>
            <translation>Mapa de robots, text o binari</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Robot maps (*.txt *.map *.rmap *.bin);;All files (*)</source>
            <translation>Mapes de robots (*.txt *.map *.rmap *.bin);;Tots els fitxers (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Rotation of the site frame, counter-clockwise [degrees] (default: as the map says, else 0)</source>
            <translation>Rotació del marc del recinte, en sentit antihorari [graus] (per defecte: la que diu el mapa, si no 0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Site CRS (default: as the map says)</source>
            <translation>SRC del recinte (per defecte: el que diu el mapa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The file {path} has {size} bytes, and a robot map at most {largest_text}: choose a map.</source>
            <translation>El fitxer {path} té {size} bytes, i un mapa de robots com a màxim {largest_text}: trieu un mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The file {path} is no robot map: it is neither UTF-8 (byte {start}) nor in the binary format, which begins with {decode}. Choose another file.</source>
            <translation>El fitxer {path} no és un mapa de robots: ni és UTF-8 (byte {start}) ni és en el format binari, que comença per {decode}. Trieu un altre fitxer.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The leading line '%{key} {meta}' of the map should hold {wanted}: correct it there, or give {parameter}.</source>
            <translation>La línia inicial '%{key} {meta}' del mapa hauria de contenir {wanted}: corregiu-la allà, o doneu {parameter}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The map's place is not known, because {why}: its layers are in local metres. Give SITE_CRS, ORIGIN and ROTATION to place it.</source>
            <translation>El lloc del mapa no es coneix, perquè {why}: les capes són en metres locals. Doneu SITE_CRS, ORIGIN i ROTATION per situar-lo.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The map's positions cannot be transformed from {crs} to longitudes and latitudes ({error}): check the map's lines crs, origin and rotation.</source>
            <translation>Les posicions del mapa no es poden transformar de {crs} a longituds i latituds ({error}): comproveu les línies crs, origin i rotation del mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The robot map {path} cannot be read: {error}</source>
            <translation>El mapa de robots {path} no es pot llegir: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The robot map {path} cannot be read: {reason}. Check its rights.</source>
            <translation>El mapa de robots {path} no es pot llegir: {reason}. Comproveu-ne els permisos.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>There is no file {file}: choose a robot map (MAP).</source>
            <translation>No hi ha cap fitxer {file}: trieu un mapa de robots (MAP).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>it names no CRS</source>
            <translation>no anomena cap SRC</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>the CRS {stated!r} that the map names is not known to QGIS</source>
            <translation>QGIS no coneix el SRC {stated!r} que el mapa anomena</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>two numbers 'x,y'</source>
            <translation>dos nombres 'x,y'</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>Layer {sourcename}, feature {id}</source>
            <translation>Capa {sourcename}, entitat {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>Qt cannot draw the picture of this map: choose svg and open that in a browser.</source>
            <translation>Qt no pot dibuixar la imatge d'aquest mapa: trieu svg i obriu-lo en un navegador.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>SPEED {text!r} is no expression ({reason}): write a field's name or a number.</source>
            <translation>SPEED {text!r} no és una expressió ({reason}): escriviu el nom d'un camp o un nombre.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>The layer {name} of the GeoPackage cannot be written: {error}.</source>
            <translation>La capa {name} del GeoPackage no es pot escriure: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>has no speed above 0 m/s, so it sets no limit; it is left out</source>
            <translation>no té cap velocitat superior a 0 m/s, així que no limita; s'omet</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>A layer cannot be written ({reason}): choose another place or format for it, and check the free space.</source>
            <translation>No es pot escriure una capa ({reason}): trieu-li un altre lloc o format, i comproveu l'espai lliure.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>it is there and is no file</source>
            <translation>ja existeix i no és un fitxer</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>no reason is given</source>
            <translation>no se'n dona cap motiu</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>the folder {folder} may not be written to</source>
            <translation>no es pot escriure a la carpeta {folder}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>there is no folder {folder}</source>
            <translation>no hi ha cap carpeta {folder}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{path} is a folder, where a file is to be written: choose another OUTPUT.</source>
            <translation>{path} és una carpeta, on s'ha d'escriure un fitxer: trieu un altre OUTPUT.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{what} cannot be written to {folder}: {reason}. Choose a folder that may be written to, and check the free space.</source>
            <translation>{what} no es pot escriure a {folder}: {reason}. Trieu una carpeta on es pugui escriure, i comproveu l'espai lliure.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{what} cannot be written to {target}: {reason}. Choose a file in a folder that exists, may be written to, and has space.</source>
            <translation>{what} no es pot escriure a {target}: {reason}. Trieu un fitxer en una carpeta que existeixi, on es pugui escriure i que tingui espai.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Both CENTER and EXTENT are given: give one of them, the window cannot be both.</source>
            <translation>S'han donat CENTER i EXTENT alhora: doneu-ne un, la finestra no pot ser tots dos.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Centre of the window (or choose an extent)</source>
            <translation>Centre de la finestra (o trieu una extensió)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Extent (instead of centre, width and height)</source>
            <translation>Extensió (en lloc de centre, amplada i alçada)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Height of the window, along y [m]</source>
            <translation>Alçada de la finestra, en y [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Layers without a CRS are in metres of the site</source>
            <translation>Les capes sense SRC són en metres del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Map profile ({kinds});;All files (*)</source>
            <translation>Perfil de mapa ({kinds});;Tots els fitxers (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Map profile: what the layers are, by their names (default: as each layer keeps it)</source>
            <translation>Perfil de mapa: què són les capes, pel seu nom (per defecte: com ho guarda cada capa)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Neither CENTER nor EXTENT is given: give the centre of the window with WIDTH and HEIGHT in metres, or an extent.</source>
            <translation>No s'ha donat ni CENTER ni EXTENT: doneu el centre de la finestra amb WIDTH i HEIGHT en metres, o una extensió.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Origin of the site frame (default: as the project has it, else 0,0)</source>
            <translation>Origen del marc del recinte (per defecte: el del projecte, si no 0,0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>ROTATION {degrees} is not finite: give a number.</source>
            <translation>ROTATION {degrees} no és finit: doneu un nombre.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Rotation of the site frame, counter-clockwise from the CRS's x axis [degrees]</source>
            <translation>Rotació del marc del recinte, en sentit antihorari des de l'eix x del SRC [graus]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>SITE_CRS {crs} is no CRS that QGIS knows: write a code such as EPSG:32633.</source>
            <translation>SITE_CRS {crs} no és un SRC que QGIS conegui: escriviu un codi com ara EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Site CRS, in metres (default: the project's, else the layers')</source>
            <translation>SRC del recinte, en metres (per defecte: el del projecte, si no el de les capes)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>The layer {layer} is no vector layer: take its role away.</source>
            <translation>La capa {layer} no és vectorial: traieu-li el paper.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Width of the window, along x [m]</source>
            <translation>Amplada de la finestra, en x [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {extent} is no extent: write 'xmin,xmax,ymin,ymax'.</source>
            <translation>{name} {extent} no és una extensió: escriviu 'xmin,xmax,ymin,ymax'.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {value} has no place in the CRS {crs}: give finite numbers, x or longitude first, and the CRS that they are in.</source>
            <translation>{name} {value} no té lloc en el SRC {crs}: doneu nombres finits, primer la x o la longitud, i el SRC en què són.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {value} is in the CRS {own}, which has no known relation to the CRS {crs}: give it in that one.</source>
            <translation>{name} {value} és en el SRC {own}, que no té cap relació coneguda amb el SRC {crs}: doneu-ho en aquest últim.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{side} is {length}: give a finite number of metres.</source>
            <translation>{side} és {length}: doneu un nombre finit de metres.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>The placed cones have no field {missing}: give a layer of a GeoPackage, or the CSV, that 'robot-bridge placements export' wrote.</source>
            <translation>Els cons col·locats no tenen el camp {missing}: doneu una capa d'un GeoPackage, o el CSV, que hagi escrit 'robot-bridge placements export'.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>There are no placed cones to report on. Check the filter of the layer, and the options of 'robot-bridge placements export'.</source>
            <translation>No hi ha cons col·locats de què informar. Comproveu el filtre de la capa i les opcions de 'robot-bridge placements export'.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>cones</source>
            <translation>cons</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>deviation in cm</source>
            <translation>desviació en cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>last bar: up to {metres:.2f} m</source>
            <translation>última barra: fins a {metres:.2f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>tolerance {cm:.4g} cm</source>
            <translation>tolerància {cm:.4g} cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A robot is lost without a message for [s]</source>
            <translation>Un robot és perdut sense missatge durant [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A robot is stale without a message for [s]</source>
            <translation>Desactualitzat sense missatge durant [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A target is reached within [m]</source>
            <translation>Un objectiu s'assoleix a menys de [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Database of the published site (PostGIS)</source>
            <translation>Base de dades del recinte publicat (PostGIS)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Folder of the published site</source>
            <translation>Carpeta del recinte publicat</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Height where none is known [m]</source>
            <translation>Alçada on no se'n coneix cap [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>It is not said where to publish: give FOLDER, a folder, or DATABASE, a PostgreSQL connection of QGIS's.</source>
            <translation>No s'ha dit on publicar: doneu FOLDER, una carpeta, o DATABASE, una connexió PostgreSQL del QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Keepout layers (default: the project's with that role)</source>
            <translation>Capes de zones prohibides (per defecte: les del projecte amb aquest paper)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Obstacle layers, stairs, ramps and furniture (default: the project's with such a role)</source>
            <translation>Capes d'obstacles, escales, rampes i mobiliari (per defecte: les del projecte amb aquest paper)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Replace the publication of another site</source>
            <translation>Substitueix la publicació d'un altre recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Road centreline layers (default: the project's with that role)</source>
            <translation>Capes d'eixos de via (per defecte: les del projecte amb aquest paper)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Road surface layers (default: the project's with that role)</source>
            <translation>Capes de superfícies de via (per defecte: les del projecte amb aquest paper)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>SITE_ID is empty and the project has no variable {site_variable}: give the site an id of letters, digits, '_', '.' and '-', such as north_yard.</source>
            <translation>SITE_ID és buit i el projecte no té la variable {site_variable}: doneu al recinte un id de lletres, dígits, '_', '.' i '-', com ara north_yard.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Site id (default: the project's)</source>
            <translation>Id del recinte (per defecte: el del projecte)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Site name (default: the project's title)</source>
            <translation>Nom del recinte (per defecte: el títol del projecte)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>The site's CRS is not known, and</source>
            <translation>El SRC del recinte no es coneix, i</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>The site's CRS, {crs_name},</source>
            <translation>El SRC del recinte, {crs_name},</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>There is nothing to publish: no layer is given and no layer of the project has a role. Give roles (Fleet Supervisor &gt; Layer roles), a PROFILE, or layers.</source>
            <translation>No hi ha res a publicar: no s'ha donat cap capa i cap capa del projecte té un paper. Doneu papers (Fleet Supervisor &gt; Papers de les capes), un PROFILE, o capes.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Where robots may be sent (default: all that is published)</source>
            <translation>On es poden enviar robots (per defecte: tot el que es publica)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Width of a road where none is known [m]</source>
            <translation>Amplada d'una via on no se'n coneix cap [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{named} has no code that a gateway knows it by: choose SITE_CRS such as EPSG:32633. Layers in local metres can be published with ORIGIN and LOCAL=true.</source>
            <translation>{named} no té cap codi pel qual el conegui una passarel·la: trieu SITE_CRS, com ara EPSG:32633. Les capes en metres locals es poden publicar amb ORIGIN i LOCAL=true.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{name} is {value}: give a number of metres above 0.</source>
            <translation>{name} és {value}: doneu un nombre de metres superior a 0.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{place} = {text} is no number: correct it there.</source>
            <translation>{place} = {text} no és un nombre: corregiu-lo allà.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{title} (default: as published, at first {default:g})</source>
            <translation>{title} (per defecte: com es va publicar, al principi {default:g})</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>E and N in metres of {crs}; {mark} beyond the tolerance of {tolerance:g} cm</source>
            <translation>E i N en metres de {crs}; {mark} fora de la tolerància de {tolerance:g} cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Mean {mean}, RMS {rms}, 95 % within {p95}, largest {most}.</source>
            <translation>Mitjana {mean}, RMS {rms}, 95 % dins de {p95}, màxima {most}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Off cm</source>
            <translation>Desv. cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Placed (UTC)</source>
            <translation>Col·locat (UTC)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Planned E</source>
            <translation>Planificat E</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Planned N</source>
            <translation>Planificat N</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>QGIS cannot make the report (layout export {number}): check the free space, and the background layers by leaving them out.</source>
            <translation>El QGIS no pot fer l'informe (exportació de la composició: {number}): comproveu l'espai lliure, i les capes de fons traient-les.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Robots: {names}</source>
            <translation>Robots: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>The report</source>
            <translation>L'informe</translation>
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
                <numerusform>{within} de %n con ({share:.0f} %) és a menys de {tolerance:g} cm del pla.</numerusform>
                <numerusform>{within} de %n cons ({share:.0f} %) són a menys de {tolerance:g} cm del pla.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>× planned   ● placed (red: beyond the tolerance)   orange: deviation</source>
            <translation>× planificat   ● col·locat (vermell: fora de la tolerància)   taronja: desviació</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>× planned   ● placed (red: beyond the tolerance)   orange: deviation, {factor} times as long</source>
            <translation>× planificat   ● col·locat (vermell: fora de la tolerància)   taronja: desviació, {factor} vegades més llarga</translation>
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
                <numerusform>%n aresta passa per zones que cal evitar, i es tanca</numerusform>
                <numerusform>%n arestes passen per zones que cal evitar, i es tanquen</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Areas that must not be driven through</source>
            <translation>Zones que no s'han de travessar</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>CRS in metres (default: the layer's, or the project's)</source>
            <translation>SRC en metres (per defecte: el de la capa o el del projecte)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Direction: yes along the line, -1 against it, no both (default: a field oneway, ...)</source>
            <translation>Sentit: yes al llarg de la línia, -1 en contra, no tots dos (per defecte: un camp oneway, ...)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Ends this near to a road were meant to meet it [m]</source>
            <translation>Extrems així de prop d'una via hi toquen [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Farthest place from a road [m]</source>
            <translation>Distància màxima a una via [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Layer {name}, feature {id}: {note}</source>
            <translation>Capa {name}, entitat {id}: {note}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Layer {name}: the width of %n roads is not known; {width:g} m is used</source>
            <translation>
                <numerusform>Capa {name}: l'amplada de %n via no es coneix; s'hi posa {width:g} m</numerusform>
                <numerusform>Capa {name}: l'amplada de %n vies no es coneix; s'hi posa {width:g} m</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Level of each road, 0 on the ground (default: fields level, layer, bridge, tunnel)</source>
            <translation>Nivell de cada via, 0 a terra (per defecte: camps level, layer, bridge, tunnel)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>No road has the surface {surfaces}: the roads have {there}.</source>
            <translation>Cap via no té la superfície {surfaces}: les vies tenen {there}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Points of the path at most this far apart [m]</source>
            <translation>Punts del camí separats com a màxim [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS {roads} cannot be opened: check the file and the layer's name.</source>
            <translation>ROADS {roads} no es pot obrir: comproveu el fitxer i el nom de la capa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS: no feature of the layer {name} is a road: each has to be a line with a length that the layer's filter keeps. {first}</source>
            <translation>ROADS: cap element de la capa {name} no és una via: cadascun ha de ser una línia amb longitud que el filtre de la capa conservi. {first}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS: the layer {name} has no features: choose the layer of the road centrelines.</source>
            <translation>ROADS: la capa {name} no té elements: trieu la capa dels eixos de via.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Repair: close gaps, cut overshoots, leave out what is drawn twice</source>
            <translation>Repara: tanca forats, talla sobrepassaments, omet el que s'ha dibuixat dues vegades</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Repaired: {kind} of feature {feature} at {where}: {text}</source>
            <translation>Reparat: {kind} de l'entitat {feature} a {where}: {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Roads at least this wide, and as wide as the robot [m]</source>
            <translation>Vies almenys així d'amples, i tant com el robot [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Speed on each road [m/s] (default: a field speed_ms, or maxspeed in km/h)</source>
            <translation>Velocitat a cada via [m/s] (per defecte: un camp speed_ms, o maxspeed en km/h)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Speed on roads of which it is not known [m/s]</source>
            <translation>Velocitat a les vies de les quals no es coneix [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Surface of each road (default: the layer's role, else a field surface)</source>
            <translation>Superfície de cada via (per defecte: el paper de la capa, si no un camp surface)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Surfaces that may be used (default: all)</source>
            <translation>Superfícies que es poden fer servir (per defecte: totes)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>The filter of its role keeps none of them.</source>
            <translation>El filtre del seu paper no en conserva cap.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Turning radius of the robot [m]</source>
            <translation>Radi de gir del robot [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Whether each road is closed (default: a field closed)</source>
            <translation>Si cada via és tancada (per defecte: un camp closed)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of each road [m] (default: the layer's role, else a field width_m or width)</source>
            <translation>Amplada de cada via [m] (per defecte: el paper de la capa, si no un camp width_m o width)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of roads of which it is not known [m]</source>
            <translation>Amplada de les vies de les quals no es coneix [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of the robot [m]</source>
            <translation>Amplada del robot [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Only the first {count} positions were fetched. Choose less time, or fewer robots.</source>
            <translation>Només s'han obtingut les primeres {count} posicions. Trieu menys temps o menys robots.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Putting positions in order</source>
            <translation>S'ordenen les posicions</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Stopped: the rest of the time was not fetched.</source>
            <translation>Aturat: no s'ha obtingut la resta del temps.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>The gateway's answer cannot be used: {error}.</source>
            <translation>La resposta de la passarel·la no es pot fer servir: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>The rest of the time was not fetched: {error}</source>
            <translation>No s'ha obtingut la resta del temps: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>What came could not be put in order.</source>
            <translation>El que ha arribat no s'ha pogut ordenar.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>{robot}: {command} · {state} by {by}</source>
            <translation>{robot}: {command} · {state} per {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source> · NOT ALL</source>
            <translation> · NO TOTES</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Choose a time and press Load.</source>
            <translation>Trieu un temps i premeu Carrega.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>How much faster than it was</source>
            <translation>Quant més de pressa que com va ser</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Loading …</source>
            <translation>Carregant …</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Loading … {positions}, up to {moment}</source>
            <translation>Carregant … {positions}, fins a {moment}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>No positions are stored of that time.</source>
            <translation>No hi ha posicions desades d'aquell temps.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>No robot is selected to be replayed. Select one, or replay all.</source>
            <translation>No hi ha cap robot seleccionat per reproduir. Seleccioneu-ne un o reproduïu-los tots.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Play what robots did, on a map beside the live one</source>
            <translation>Reprodueix el que han fet els robots, en un mapa al costat del que és en viu</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Play, or hold (Space)</source>
            <translation>Reprodueix o atura (Espai)</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>REPLAY · {status}</source>
            <translation>REPRODUCCIÓ · {status}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>REPLAY, not live · {moment} · {status}</source>
            <translation>REPRODUCCIÓ, no en viu · {moment} · {status}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Replay</source>
            <translation>Reproducció</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>The replay was not loaded: {error}</source>
            <translation>La reproducció no s'ha carregat: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>The replay's time ends before it begins. Correct one of the two.</source>
            <translation>El temps de la reproducció acaba abans de començar. Corregiu-ne un dels dos.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>There is nothing to replay yet. Connect to a gateway first.</source>
            <translation>Encara no hi ha res per reproduir. Connecteu-vos primer a una passarel·la.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>positions: {positions}, robots: {robots}</source>
            <translation>posicions: {positions}, robots: {robots}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Drawing what robots drove</source>
            <translation>Es dibuixa el que han recorregut els robots</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Not all trajectories are drawn: {error}</source>
            <translation>No s'han dibuixat totes les trajectòries: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>The trajectories are not drawn: they could not be made into lines.</source>
            <translation>Les trajectòries no s'han dibuixat: no s'han pogut convertir en línies.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Trajectories (replay)</source>
            <translation>Trajectòries (reproducció)</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>From</source>
            <translation>Des de</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>From when on</source>
            <translation>Des de quan</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Load</source>
            <translation>Carrega</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Load what the selected robots did, not what all did</source>
            <translation>Carrega el que han fet els robots seleccionats, no el que han fet tots</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Selected only</source>
            <translation>Només els seleccionats</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>To</source>
            <translation>Fins a</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Until when</source>
            <translation>Fins quan</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>from … to …</source>
            <translation>de … a …</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 15 minutes</source>
            <translation>els darrers 15 minuts</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 5 minutes</source>
            <translation>els darrers 5 minuts</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 8 hours</source>
            <translation>les darreres 8 hores</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last hour</source>
            <translation>la darrera hora</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>%n connections from {file}.</source>
            <translation>
                <numerusform>%n connexió de {file}.</numerusform>
                <numerusform>%n connexions de {file}.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>%n connections in {file}, without tokens.</source>
            <translation>
                <numerusform>%n connexió a {file}, sense testimoni.</numerusform>
                <numerusform>%n connexions a {file}, sense testimonis.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Authentication</source>
            <translation>&amp;Autenticació</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Edit…</source>
            <translation>&amp;Edita…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Import…</source>
            <translation>&amp;Importa…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;New…</source>
            <translation>&amp;Nova…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Operator</source>
            <translation>&amp;Operador</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Remove</source>
            <translation>&amp;Treu</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Test</source>
            <translation>&amp;Prova</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Token</source>
            <translation>&amp;Testimoni</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>CA &amp;file</source>
            <translation>&amp;Fitxer de CA</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connecting to {name} …</source>
            <translation>Connectant a {name} …</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connecting …</source>
            <translation>Connectant …</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connections (*.json)</source>
            <translation>Connexions (*.json)</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connections to gateways</source>
            <translation>Connexions a passarel·les</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>E&amp;xport…</source>
            <translation>E&amp;xporta…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Edit connection</source>
            <translation>Edita la connexió</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Export connections</source>
            <translation>Exporta connexions</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Gateway</source>
            <translation>Passarel·la</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Import connections</source>
            <translation>Importa connexions</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Name</source>
            <translation>Nom</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>New connection</source>
            <translation>Connexió nova</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Press New… for a gateway, or Import… for those that another computer has exported.</source>
            <translation>Premeu Nova… per a una passarel·la, o Importa… per a les que ha exportat un altre ordinador.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Removed: {names}. Tokens stay in QGIS's authentication.</source>
            <translation>Tret: {names}. Els testimonis es queden a l'autenticació del QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Replaced: {replaced}.</source>
            <translation>Substituïdes: {replaced}.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>T&amp;est</source>
            <translation>&amp;Prova</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>There is a connection {name} already. Give this one another name.</source>
            <translation>Ja hi ha una connexió {name}. Doneu un altre nom a aquesta.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>connection test</source>
            <translation>prova de connexió</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>kept by QGIS, encrypted; or choose one below</source>
            <translation>el desa el QGIS, xifrat; o trieu-ne un a sota</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>such as the site's name</source>
            <translation>com ara el nom del recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>who you are, in every log</source>
            <translation>qui sou, a cada registre</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{file} cannot be written: {error}</source>
            <translation>{file} no es pot escriure: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{site} ({crs}) answers, as {who}.</source>
            <translation>{site} ({crs}) respon, com a {who}.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{site} ({crs}) answers.</source>
            <translation>{site} ({crs}) respon.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>Choose a file that Export wrote.</source>
            <translation>Trieu un fitxer que hagi escrit Exporta.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>QGIS did not give the token that it keeps: its master password was not given. Press Connect and enter it, or enter the token under Access.</source>
            <translation>El QGIS no ha donat el testimoni que desa: no se n'ha donat la contrasenya mestra. Premeu Connecta i introduïu-la, o introduïu el testimoni a Accés.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>QGIS did not keep the token: its master password was not given. The token is used now and has to be entered again next time.</source>
            <translation>El QGIS no ha desat el testimoni: no se n'ha donat la contrasenya mestra. El testimoni es fa servir ara i s'haurà de tornar a introduir la propera vegada.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The authentication {config} is of the method {method}, which gateways do not know. Choose one of the method {wanted} with the token as its password.</source>
            <translation>L'autenticació {config} és del mètode {method}, que les passarel·les no coneixen. Trieu-ne una del mètode {wanted} amb el testimoni com a contrasenya.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The authentication {config} that the connection names is not in this QGIS. Edit the connection and choose another, or enter the token.</source>
            <translation>L'autenticació {config} que anomena la connexió no és en aquest QGIS. Editeu la connexió i trieu-ne una altra, o introduïu el testimoni.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The connection has no name. Give it one, such as the site's.</source>
            <translation>La connexió no té nom. Doneu-n'hi un, com ara el del recinte.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>This QGIS keeps no authentication (its options say why, under Authentication): enter the token under Access.</source>
            <translation>Aquest QGIS no desa autenticació (les seves opcions diuen per què, a Autenticació): introduïu el testimoni a Accés.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} has no list named connections. {choose}</source>
            <translation>{source} no té cap llista anomenada connections. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} holds no connections to gateways. {choose}</source>
            <translation>{source} no conté connexions a passarel·les. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} is not JSON: {error}. {choose}</source>
            <translation>{source} no és JSON: {error}. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} is of version {found}; this plugin reads version {version}. Update the plugin.</source>
            <translation>{source} és de la versió {found}; aquest connector llegeix la versió {version}. Actualitzeu el connector.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source}: connection {number} is not a set of texts named {keys}. {choose}</source>
            <translation>{source}: la connexió {number} no és un conjunt de textos anomenats {keys}. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source}: connection {number}: {error}</source>
            <translation>{source}: connexió {number}: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice fleet ended: {why}. Start it again; if that fails, see what {program} says by hand.</source>
            <translation>La flota de pràctica s'ha acabat: {why}. Torneu-la a arrencar; si falla, mireu què diu {program} a mà.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice fleet needs robot-bridge, which is not on this computer. In a terminal, in the project's folder: python3 -m venv gateway, then gateway/bin/pip install . and put gateway/bin on PATH; or make setup. Then restart QGIS. The tour can be read without it.</source>
            <translation>La flota de pràctica necessita robot-bridge, que no és en aquest ordinador. En un terminal, a la carpeta del projecte: python3 -m venv gateway, després gateway/bin/pip install . i poseu gateway/bin al PATH; o make setup. Després reinicieu QGIS. La visita es pot llegir sense ell.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice robot {robot} does not run: {why}. Close the tour and start the practice fleet again; if that fails, see what {program} says by hand.</source>
            <translation>El robot de pràctica {robot} no funciona: {why}. Tanqueu la visita i torneu a arrencar la flota de pràctica; si falla, mireu què diu {program} a mà.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>it ended with code {code}</source>
            <translation>ha acabat amb el codi {code}</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Back</source>
            <translation>&amp;Enrere</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Finish</source>
            <translation>&amp;Acaba</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Next</source>
            <translation>&amp;Següent</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>A five-minute tour shows how it works.</source>
            <translation>Un recorregut de cinc minuts mostra com funciona.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>A site is an ordinary QGIS project: an orthophoto, roads, obstacles, each layer with a role. Open the sample site; QGIS asks first if your own project is not saved.</source>
            <translation>Un recinte és un projecte de QGIS corrent: una ortofoto, vies, obstacles, cada capa amb un paper. Obriu el recinte d'exemple; QGIS pregunta abans si el vostre projecte no està desat.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Abort robot: the selected robots give up their task. ABORT ALL: every robot does. EMERGENCY STOP (F10): every robot stops now, and none can be sent anywhere until a supervisor clears it.</source>
            <translation>Avorta robot: els robots seleccionats abandonen la tasca. AVORTA-HO TOT: tots. PARADA D'EMERGÈNCIA (F10): tots els robots s'aturen ara, i cap no es pot enviar enlloc fins que un supervisor ho aixequi.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>An arrow shows where a robot heads, its colour and shape the state. Hold the mouse over one for its card; with Select robot a click selects, a rectangle selects several, a double click goes there.</source>
            <translation>Una fletxa mostra cap on mira un robot, el color i la forma l'estat. Deixeu-hi el ratolí a sobre per veure'n la fitxa; amb Selecciona robot un clic selecciona, un rectangle en selecciona diversos, un doble clic hi va.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>C&amp;lose</source>
            <translation>&amp;Tanca</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Click r1: it is selected on the map, too.</source>
            <translation>Feu clic a r1: també queda seleccionat al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Closing it ends the practice fleet. What else the desk does is in the operator's guide, docs/operator.md; how real robots are connected in docs/integrator.md.</source>
            <translation>En tancar-la s'acaba la flota de pràctica. Què més fa la consola és a la guia de l'operador, docs/operator.md; com es connecten robots reals, a docs/integrator.md.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Cone target, a click on the map, Enter: that sends the selected robot. Before that it is a draft, checked against the site; Esc takes it away, and nothing was sent.</source>
            <translation>Objectiu de con, un clic al mapa, Retorn: això envia el robot seleccionat. Abans és un esborrany, comprovat amb el recinte; Esc el treu, i no s'ha enviat res.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Each robot has a row: its state, its task, its battery, and how old its last message is. A robot that falls silent is stale, then lost; it stays on the map, marked.</source>
            <translation>Cada robot té una fila: l'estat, la tasca, la bateria, i l'edat de l'últim missatge. Un robot que calla queda desactualitzat, després perdut; es queda al mapa, marcat.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Every command is here with each of its steps: queued, delivered, acknowledged, reached; or why it failed. A double click shows its place on the map.</source>
            <translation>Aquí hi ha cada ordre amb tots els passos: en cua, lliurada, reconeguda, assolida; o per què ha fallat. Un doble clic en mostra el lloc al mapa.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Five minutes with a practice fleet</source>
            <translation>Cinc minuts amb una flota de pràctica</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Here stand the gateway's address and your name, which every log shows. For a real fleet write them and press Connect. For the tour, start the practice fleet: it connects by itself.</source>
            <translation>Aquí hi ha l'adreça de la passarel·la i el vostre nom, que mostren tots els registres. Per a una flota real escriviu-los i premeu Connecta. Per a la visita, arrenqueu la flota de pràctica: es connecta sola.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Open the sample site</source>
            <translation>Obre el recinte d'exemple</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Send a robot</source>
            <translation>Enviar un robot</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Start the practice fleet</source>
            <translation>Arrenca la flota de pràctica</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Start the tour</source>
            <translation>Comença la visita</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Starting …</source>
            <translation>Arrencant …</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>That was the tour</source>
            <translation>Això era la visita</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The desk is connected to another gateway. Disconnect first: the tour moves no real robots.</source>
            <translation>La consola està connectada a una altra passarel·la. Desconnecteu abans: la visita no mou robots reals.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The link</source>
            <translation>L'enllaç</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The map</source>
            <translation>El mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The practice fleet runs, and the desk is connected to it.</source>
            <translation>La flota de pràctica funciona, i la consola hi està connectada.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The robots</source>
            <translation>Els robots</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The sample site is open.</source>
            <translation>El recinte d'exemple és obert.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The sample site was not opened: {path}.</source>
            <translation>El recinte d'exemple no s'ha obert: {path}.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The site</source>
            <translation>El recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The tour needs no network: a gateway and three simulated robots run on this computer, and nothing real moves. Next and Back lead on, Esc closes. It is in the menu Plugins &gt; Fleet Supervisor &gt; Tour.</source>
            <translation>La visita no necessita xarxa: una passarel·la i tres robots simulats funcionen en aquest ordinador, i res de real es mou. Següent i Enrere hi porten, Esc la tanca. És al menú Connectors &gt; Fleet Supervisor &gt; Visita.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Tour</source>
            <translation>Visita</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Try it: only practice robots stop. Then clear it in the red banner.</source>
            <translation>Proveu-ho: només s'aturen robots de pràctica. Després aixequeu-la a la franja vermella.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Try it: press Cone target, click on the road near r1, then Enter.</source>
            <translation>Proveu-ho: premeu Objectiu de con, feu clic a la via prop de r1, i Retorn.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>What became of it</source>
            <translation>Què se n'ha fet</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Abort robot</source>
            <translation>Avorta robot</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Add to queue</source>
            <translation>Afegeix a la cua</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Clear emergency stop…</source>
            <translation>Aixeca la parada d'emergència…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Close a road for every robot by a click on it, or open a closed one again</source>
            <translation>Tanca una via a tots els robots amb un clic, o torna a obrir-ne una de tancada</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Cone target</source>
            <translation>Objectiu de con</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Connect to the gateway, or disconnect</source>
            <translation>Connecta a la passarel·la, o desconnecta</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Continue</source>
            <translation>Continua</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Coordinates…</source>
            <translation>Coordenades…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Draw a route for the selected robot: click its points, right click ends drawing, drag points or lines to change it, Backspace takes the last one back, Enter or Send sends, Esc cancels</source>
            <translation>Dibuixa una ruta per al robot seleccionat: feu clic als punts, el clic dret acaba el dibuix, arrossegueu punts o línies per canviar-la, Retrocés treu l'últim, Retorn o Envia l'envia, Esc cancel·la</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Draw route</source>
            <translation>Dibuixa ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every robot gives up its task, at once and without a question</source>
            <translation>Tots els robots abandonen la tasca, de seguida i sense preguntar</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every robot stops now, and none can be sent anywhere until a supervisor clears it ({one_key} or {other_key})</source>
            <translation>Tots els robots s'aturen ara, i cap no es pot enviar enlloc fins que un supervisor ho aixequi ({one_key} o {other_key})</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every selected robot gives up its task at once</source>
            <translation>Cada robot seleccionat abandona la tasca de seguida</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every selected robot stands at once and keeps its task, until it is let go on with Continue</source>
            <translation>Cada robot seleccionat s'atura de seguida i conserva la tasca, fins que se'l deixa seguir amb Continua</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Fleet panel</source>
            <translation>Tauler de la flota</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Follow</source>
            <translation>Segueix</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep all in view</source>
            <translation>Tots a la vista</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep every robot in view</source>
            <translation>Mantén a la vista tots els robots</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep the selected robots in view</source>
            <translation>Mantén a la vista els robots seleccionats</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let a draft be sent in spite of what the checks found; asks why</source>
            <translation>Permet enviar un esborrany malgrat el que han trobat les comprovacions; demana per què</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let robots be sent again; takes a supervisor, and asks first</source>
            <translation>Permet tornar a enviar robots; cal un supervisor, i abans pregunta</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let the route begin at its end; R over the map does so too</source>
            <translation>Fes que la ruta comenci pel final; R sobre el mapa també ho fa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let the selected robots that are paused go on with their tasks, from where they stand</source>
            <translation>Deixa que els robots seleccionats que estan en pausa segueixin amb les seves tasques, des d'on són</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Make the change again that was taken back; Ctrl+Shift+Z over the map does so too</source>
            <translation>Torna a fer el canvi desfet; Ctrl+Maj+Z sobre el mapa també ho fa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Make the draft of what is selected in the active layer: a point, a line, or many points</source>
            <translation>Fes l'esborrany amb el que hi ha seleccionat a la capa activa: un punt, una línia o molts punts</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Pause robot</source>
            <translation>Posa robot en pausa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Put what is drawn at the end of its robot's queue, instead of sending it</source>
            <translation>Posa el dibuixat al final de la cua del seu robot, en lloc d'enviar-ho</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Redo</source>
            <translation>Refés</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Route along the roads for the selected robot: the way to the mouse is shown, a click takes it, right click ends drawing; Backspace takes the last leg back, Enter or Send sends, Esc cancels</source>
            <translation>Ruta per vies per al robot seleccionat: es mostra el recorregut fins al ratolí, un clic l'agafa, el clic dret acaba el dibuix; Retrocés treu l'últim tram, Retorn o Envia l'envia, Esc cancel·la</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Say how Route on roads is to lead: shortest or fastest, on which surfaces, off the roads of other robots</source>
            <translation>Digues com ha de portar la Ruta per vies: la més curta o la més ràpida, per quines superfícies, fora de les vies d'altres robots</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Select robot</source>
            <translation>Selecciona robot</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Select robots on the map: click one or drag a rectangle, with Shift to add, with Ctrl to take away; double click goes there</source>
            <translation>Selecciona robots al mapa: feu clic en un o arrossegueu un rectangle, amb Maj per afegir, amb Ctrl per treure; el doble clic hi va</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send map</source>
            <translation>Envia mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send the selected robots the map of the whole site now</source>
            <translation>Envia ara als robots seleccionats el mapa de tot el recinte</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send what is drawn on the map to its robot</source>
            <translation>Envia al seu robot el que hi ha dibuixat al mapa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Set a cone target for the selected robot: click, then Enter or Send; Esc cancels</source>
            <translation>Posa un objectiu de con per al robot seleccionat: clic, i després Retorn o Envia; Esc cancel·la</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Show or hide the fleet panel</source>
            <translation>Mostra o amaga el tauler de la flota</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Start position</source>
            <translation>Posició inicial</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take from layer</source>
            <translation>De la capa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take the last change of the draft back; Ctrl+Z over the map does so too</source>
            <translation>Desfés l'últim canvi de l'esborrany; Ctrl+Z sobre el mapa també ho fa</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take what is drawn off the map; nothing is sent</source>
            <translation>Treu del mapa el dibuixat; no s'envia res</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Tell the selected robot where it stands: click, or drag to where it points; then Enter or Send</source>
            <translation>Digueu al robot seleccionat on és: clic, o arrossegueu cap on mira; després Retorn o Envia</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Turn route round</source>
            <translation>Gira la ruta</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Type or paste coordinates in any CRS in place of a click</source>
            <translation>Escriviu o enganxeu coordenades en qualsevol SRC en lloc d'un clic</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Undo</source>
            <translation>Desfés</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Ways on roads…</source>
            <translation>Camins per vies…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>{key} is the key of the EMERGENCY STOP and does not perform {action}. Give that another key in Settings &gt; Keyboard Shortcuts.</source>
            <translation>{key} és la tecla de la PARADA D'EMERGÈNCIA i no executa {action}. Doneu-li una altra tecla a Configuració &gt; Dreceres de teclat.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/language.py" />
            <source>{state}, last heard {age} ago over {link}</source>
            <translation>{state}, últim missatge fa {age} per {link}</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/scheduling.py" />
            <source>a fault of the plugin: {error}. View &gt; Panels &gt; Log Messages says where: report it.</source>
            <translation>una fallada del connector: {error}. Visualitza &gt; Taulers &gt; Missatges de registre diu on: informeu-ne.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/tables.py" />
            <source>{file} was not written ({why}). Choose another folder, or close the file where it is open.</source>
            <translation>{file} no s'ha escrit ({why}). Trieu una altra carpeta, o tanqueu el fitxer on sigui obert.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/vendored.py" />
            <source>The Python package websockets is missing, which the connection to the gateway needs. Install the plugin from its release zip, which contains it, or run 'python3 -m pip install websockets' with the Python that QGIS uses, and restart QGIS.</source>
            <translation>Falta el paquet de Python websockets, que necessita la connexió amb la passarel·la. Instal·leu el connector des del zip publicat, que el conté, o executeu 'python3 -m pip install websockets' amb el Python de QGIS, i reinicieu QGIS.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/vendored.py" />
            <source>The Python package websockets {version} in {path} is too old for the connection to the gateway. Install the plugin from its release zip, which contains a newer one, or run 'python3 -m pip install "websockets&gt;={oldest}"' with the Python that QGIS uses, and restart QGIS.</source>
            <translation>El paquet de Python websockets {version} a {path} és massa antic per a la connexió amb la passarel·la. Instal·leu el connector des del zip publicat, que en conté un de més nou, o executeu 'python3 -m pip install "websockets&gt;={oldest}"' amb el Python de QGIS, i reinicieu QGIS.</translation>
        </message>
    </context>
</TS>
